"""Routing -> strokes: walk the involution, then make each walk a line worth editing."""

from __future__ import annotations

from .build import build
from .walk import Walk, lowest_branch, walk

__all__ = ["Walk", "build", "lowest_branch", "walk"]
