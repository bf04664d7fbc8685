"""What was made to draw with is kept for the next redraw: batches, labels, sizes of texts."""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Callable, Hashable
from typing import Any, TypeVar

Made = TypeVar("Made")

_MAX_KEPT = 64
_kept: OrderedDict[Hashable, Any] = OrderedDict()


def kept(key: Hashable, make: Callable[[], Made]) -> Made:
    """What was made for this key before, or is made now.

    Args:
        key: everything that the result depends on.
    """
    if key in _kept:
        _kept.move_to_end(key)
    else:
        _kept[key] = make()
        while len(_kept) > _MAX_KEPT:
            _kept.popitem(last=False)
    return _kept[key]


def forget() -> None:
    """Free all of it."""
    _kept.clear()
