"""Words in the user's language. The English texts in the code are the keys: see `ui.language`."""

from __future__ import annotations

from bpy.app.translations import pgettext_iface, pgettext_rpt


def label(text: str, **values: object) -> str:
    """A text of the interface; `values` fill its {places}."""
    return _filled(pgettext_iface(text), values)


def message(text: object, **values: object) -> str:
    """A sentence that is reported, such as an error; `values` fill its {places}."""
    return _filled(pgettext_rpt(str(text)), values)


def _filled(text: str, values: dict[str, object]) -> str:
    return text.format(**values) if values else text
