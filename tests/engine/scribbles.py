"""Drawings to search for failures with: what fails shrinks to a drawing of few strokes."""

from __future__ import annotations

from hypothesis import strategies as st


def scribbles(most: int = 8) -> st.SearchStrategy[list[int]]:
    """Up to so many strokes for the fixture `scribble`, a number each.

    A number makes the same stroke whatever else is drawn, so that strokes can be taken away one by
    one while the failure stays.
    """
    return st.lists(st.integers(0, 9999), min_size=1, max_size=most, unique=True)
