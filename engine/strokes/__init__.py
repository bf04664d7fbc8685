"""Routing -> strokes: walk the involution, then make each walk a line worth editing.

page        what all strokes share: sampled branches, the pen, the inks
walk        half-branches in the order in which a pen would have drawn them
lines       all walks laid end to end, so that the steps below run over the page at once
corners     where lines turn suddenly, and sharp again
smooth      no wobble, no kink at junctions
simplify, bezier    few points
build       all of these in order
"""

from __future__ import annotations

from .build import build
from .shared import Page
from .walk import Walk, walk

__all__ = ["Page", "Walk", "build", "walk"]
