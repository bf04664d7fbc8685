"""Involute's vectorizer as a plain Python library; nothing in here knows Blender.

The names below are loaded on first use, so that importing the package costs nothing.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from .drawing import Drawing
    from .errors import Cancelled, InvoluteError
    from .kept_stages import KeptStages
    from .pipeline import vectorize
    from .settings import Settings
    from .values import Bundle, Junction, Stroke

_HOMES = {
    "Bundle": "values",
    "Cancelled": "errors",
    "Drawing": "drawing",
    "InvoluteError": "errors",
    "Junction": "values",
    "KeptStages": "kept_stages",
    "Settings": "settings",
    "Stroke": "values",
    "vectorize": "pipeline",
}
__all__ = [
    "Bundle",
    "Cancelled",
    "Drawing",
    "InvoluteError",
    "Junction",
    "KeptStages",
    "Settings",
    "Stroke",
    "vectorize",
]


def __getattr__(name: str) -> Any:
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(f".{_HOMES[name]}", __name__), name)
