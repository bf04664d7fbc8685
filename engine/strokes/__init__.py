"""Routing -> strokes: walk the involution, then make each walk a line worth editing."""

from __future__ import annotations

from .build import build
from .page import Page
from .walk import Walk, walk

__all__ = ["Page", "Walk", "build", "walk"]
