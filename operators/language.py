"""Words in the user's language. The English texts in the code are the keys: see `ui.language`."""

from __future__ import annotations

from bpy.app.translations import pgettext_iface, pgettext_rpt

from .engine_sentences import in_their_words


def label(text: str, **values: object) -> str:
    """A text of the interface; `values` fill its {places}."""
    said = pgettext_iface(text)
    return said.format(**values) if values else said


def reported(problem: RuntimeError) -> str:
    """What an operator has reported that was called by another one: Blender raises it."""
    return str(problem).strip().removeprefix("Error: ")


def message(text: object, **values: object) -> str:
    """A sentence that is reported, such as an error; `values` fill its {places}.

    Without values it may be one of the engine's, which comes filled.
    """
    if not values:
        return in_their_words(str(text))
    return pgettext_rpt(str(text)).format(**values)
