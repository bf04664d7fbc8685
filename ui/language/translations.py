"""The interface in other languages than English; a table per language."""

from __future__ import annotations

import bpy

from .german import TEXTS as GERMAN

_LANGUAGES = {"de_DE": GERMAN}
_CONTEXTS = (
    bpy.app.translations.contexts.default,
    bpy.app.translations.contexts.operator_default,  # names and buttons of operators
)


def register() -> None:
    """Make the tables known to Blender."""
    tables = {
        language: {(context, text): said for text, said in table.items() for context in _CONTEXTS}
        for language, table in _LANGUAGES.items()
    }
    bpy.app.translations.register(__package__, tables)


def unregister() -> None:
    """Forget them again."""
    bpy.app.translations.unregister(__package__)
