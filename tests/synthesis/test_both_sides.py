"""Sheets with something on their back, to choose the limits of what is left out by."""

from __future__ import annotations

import numpy as np
from involute.synthesis.hard_pages import both_sides


def test_a_sheet_with_a_back_side_says_what_is_on_it() -> None:
    rng = np.random.default_rng(4)
    line = np.stack([np.linspace(40, 460, 60), np.linspace(60, 420, 60)], 1).astype(np.float32)
    kinds = {}
    for _ in range(12):
        page = both_sides(rng, [line], [line[:, ::-1] + np.float32((0, 20))], 500)
        kinds[page.kind] = page
        assert not (page.wanted & page.other).any()
    assert kinds.keys() == {"back", "pencil", "front"}
    assert kinds["back"].wanted.sum() > 500
    assert not kinds["pencil"].wanted.any()
    assert kinds["pencil"].other.sum() > kinds["front"].other.sum()
