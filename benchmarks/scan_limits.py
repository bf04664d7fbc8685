"""What the limits of the scan stage are worth on held-out pages that say what is what.

    python -m benchmarks run scan_limits --data TRAIN [--pages N]

Pages of several pens (`synthesis.hard_pages`): how much of the broad lines is found, and how much
of what is found is none. Ruled sheets: how much of the rules is left, and how much of the drawing
went with them. Close hatching: how much of it is lost, and how much bare paper is taken for ink.
Each limit is set to other values around its own.
"""

from __future__ import annotations

import argparse
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from itertools import islice
from pathlib import Path
from types import ModuleType
from typing import Any

import cv2
import numpy as np
from involute.engine import Settings
from involute.engine.fills.solids import split_solids
from involute.engine.scan import paper, read_scan, ruling, wide_lines
from involute.engine.values import Scan
from involute.synthesis.composed_pages import Library
from involute.synthesis.hard_pages import HardPage, hatched, ruled_sheet, several_pens
from involute.synthesis.held_out_pages import endless

from .run_record import Figures
from .tables import markdown

Array = np.ndarray
_SIZE = 800  # px of a page
_LEFT = 0.25  # ink; more of a rule is left on the page
_GONE = 0.25  # ink; less of a line is gone
# Limits and the values they are tried with, their own among them.
BROAD: dict[str, Sequence[Any]] = {
    "_LONG": (4.0, 5.0, 6.0, 8.0),
    "_UNEVEN": (0.15, 0.2, 0.3, 0.4),
    "_EVEN": (0.65, 0.8, 0.9),
    "_SWOLLEN": (1.6, 2.0, 2.6, 4.0, 99.0),
    "_SOLID": (0.85, 0.91, 0.945, 0.96, 0.975),
    "_WIDEST": ((8.0, 16.0), (12.0, 16.0), (16.0, 16.0), (20.0, 16.0)),
}
CLOSE: dict[str, Sequence[Any]] = {
    "_HATCHED": ((1.2, 0.02), (1.5, 0.01), (1.5, 0.02), (1.5, 0.03), (2.0, 0.02), (99.0, 9.0)),
    "_LITTLE": (0.25, 0.35, 0.45, 0.55),
    "_LIGHT": (0.03, 0.04, 0.06),
}
RULES: dict[str, Sequence[Any]] = {"_MOST_HIDDEN": (0.3, 0.4, 0.5, 0.6, 0.7, 0.8)}


def main(argv: Sequence[str] | None = None) -> Figures:
    """The command line."""
    parser = argparse.ArgumentParser(
        prog="python -m benchmarks run scan_limits", description=__doc__.split("\n")[0]
    )
    parser.add_argument("--data", type=Path, required=True, help="folder of SOURCE.npz drawings")
    parser.add_argument("--pages", type=int, default=40, help="of each kind")
    parser.add_argument("--seed", type=int, default=71)
    options = parser.parse_args(argv)
    cv2.setNumThreads(1)
    library = Library.load(options.data, held_out=True)
    rows, figures = [], {}
    broad = list(_pages(several_pens, library, options.pages, options.seed))
    scans = [(page, read_scan(page.gray, Settings(sheet=False))) for page in broad]
    for name, value, said in _tried(wide_lines, BROAD):
        with _changed(wide_lines, name, value):
            figures[said] = broad_lines(scans)
        rows.append([said, *(f"{share:.3f}" for share in figures[said].values())])
    print(markdown(["broad lines", "found", "false", "left"], rows), flush=True)
    rows = []
    ruled = list(_pages(ruled_sheet, library, options.pages, options.seed + 1))
    for name, value, said in _tried(ruling, RULES):
        with _changed(ruling, name, value):
            figures[said] = rules_left(ruled)
        rows.append([said, *(f"{share:.3f}" for share in figures[said].values())])
    print(markdown(["rules", *figures[said]], rows), flush=True)
    rows = []
    close = list(_pages(hatched, library, options.pages, options.seed + 2))
    for name, value, said in _tried(paper, CLOSE):
        with _changed(paper, name, value):
            figures[said] = hatching_lost(close)
        rows.append([said, *(f"{share:.4f}" for share in figures[said].values())])
    print(markdown(["hatching", *figures[said]], rows))
    return figures


def _pages(
    kind: Callable[..., HardPage], library: Library, count: int, seed: int
) -> Iterator[HardPage]:
    rng = np.random.default_rng(seed)
    for strokes in islice(endless(rng, library), count):
        yield kind(rng, [line * (_SIZE / 1000) for line in strokes], _SIZE)


def broad_lines(pages: Sequence[tuple[HardPage, Scan]]) -> dict[str, float]:
    """Shares of the pixels of broad lines that are found as such, of what is found that are none,
    and of broad lines that are neither line nor area."""
    wanted = found = false = neither = 0
    for page, scan in pages:
        wide = wide_lines.find_wide_lines(scan, Settings())
        label = wide.label if wide.any else np.zeros(scan.ink.shape, np.int32)
        rest, _ = split_solids(scan, Settings(), wide.near if wide.any else None)
        label = cv2.resize(label, page.gray.shape[::-1], interpolation=cv2.INTER_NEAREST) > 0
        wanted += int(page.wanted.sum())
        found += int((label & page.wanted).sum())
        false += int((label & page.other).sum())
        left = cv2.resize(rest.ink, page.gray.shape[::-1]) > 0.3
        neither += int((left & page.wanted & ~label).sum())
    total = max(1, wanted)
    return {"found": found / total, "false": false / total, "left": neither / total}


def rules_left(pages: Sequence[HardPage]) -> dict[str, float]:
    """By kind of sheet: the share of the pixels of rules that are left; and of all drawings, the
    share that went."""
    left: dict[str, list[int]] = {}
    drawn = gone = 0
    for page in pages:
        gray = page.gray.astype(np.float32) / 255
        ink, _ = paper.flattened(gray)
        kept, _ = paper.flattened(gray, rules=False)
        one = left.setdefault(page.kind, [0, 0])
        one[0] += int((page.wanted & (ink > _LEFT)).sum())
        one[1] += int((page.wanted & (kept > _LEFT)).sum())
        drawn += int((page.other & (kept > 2 * _GONE)).sum())
        gone += int((page.other & (kept > 2 * _GONE) & (ink < _GONE)).sum())
    shares = {kind: a / max(1, b) for kind, (a, b) in sorted(left.items()) if b}
    return shares | {"drawing gone": gone / max(1, drawn)}


def hatching_lost(pages: Sequence[HardPage]) -> dict[str, float]:
    """The share of the pixels of close hatching that is lost, and of bare paper that is ink."""
    wanted = lost = bare = inked = 0
    for page in pages:
        ink = paper.flatten_paper(page.gray.astype(np.float32) / 255) > _GONE
        wanted, lost = wanted + int(page.wanted.sum()), lost + int((page.wanted & ~ink).sum())
        bare, inked = bare + int(page.other.sum()), inked + int((page.other & ink).sum())
    return {"lost": lost / max(1, wanted), "inked": inked / max(1, bare)}


def _tried(module: ModuleType, limits: dict[str, Sequence[Any]]) -> Iterator[tuple[str, Any, str]]:
    for name, values in limits.items():
        own = getattr(module, name)
        for value in values:
            yield name, value, f"{name} {value}" + (" (in force)" if value == own else "")


@contextmanager
def _changed(module: ModuleType, name: str, value: object) -> Iterator[None]:
    own = getattr(module, name)
    setattr(module, name, value)
    try:
        yield
    finally:
        setattr(module, name, own)


if __name__ == "__main__":
    main()
