"""The interface in other languages than English; a table per language."""

from __future__ import annotations

import bpy

from .french import TEXTS as FRENCH
from .german import TEXTS as GERMAN
from .japanese import TEXTS as JAPANESE

_LANGUAGES = {"de_DE": GERMAN, "fr_FR": FRENCH, "ja_JP": JAPANESE}
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
