"""Scan -> LineMaps: where the centre of every line runs.

One Protocol, several providers: the trained network, a classical ridge filter that needs no
weights, and "given" for an input that already is a centerline image.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Protocol

from ..settings import Settings
from ..values import LineMaps, Scan

Tick = Callable[[float], None]


class CenterlineProvider(Protocol):
    """Turns a scan into line maps; calls tick(fraction) now and then, which may raise Cancelled."""

    def __call__(self, scan: Scan, tick: Tick) -> LineMaps: ...


def provider_for(settings: Settings) -> CenterlineProvider:
    """The provider that the settings ask for; "auto" = the network when its weights are there."""
    if settings.provider == "given":
        from .given import given

        return given
    if settings.provider != "classical":
        from . import learned

        if settings.provider in ("network", "lean") or learned.available():
            return learned.provider(settings)
    from .classical import classical

    return classical
