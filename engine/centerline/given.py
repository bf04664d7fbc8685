"""The provider for an input that already is a centerline image, white on black."""

from __future__ import annotations

from collections.abc import Callable

from ..values import LineMaps, Scan


def given(scan: Scan, tick: Callable[[float], None]) -> LineMaps:
    """Use the picture itself as the centerline map."""
    tick(1.0)
    return LineMaps(scan.ink)
