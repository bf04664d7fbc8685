"""Ink lost and invented on aliased 1-bit lines, the standard of digital animation.

    python -m benchmarks run aliased [--widths 1 2 3 4] [--every 2] [--jobs 2]

The true strokes of every second benchmark drawing, drawn black on white by integers alone: no
grey, no noise, one width a page. The page itself is the ink that must be found.
"""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from pathlib import Path

import cv2
import numpy as np
from involute.engine import vectorize

from .judged_pages import DATA, JudgedPage, pages
from .lost_and_invented import Fidelity, fidelity, side_by_side
from .metrics import LONG_SIDE
from .run_record import Figures

Array = np.ndarray

_SUB = 4  # binary digits of sub-pixel positions


def main(argv: Sequence[str] | None = None) -> Figures:
    """The command line."""
    parser = argparse.ArgumentParser(
        prog="python -m benchmarks run aliased",
        description=__doc__,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("--data", type=Path, default=DATA, help="folder with a manifest.json")
    parser.add_argument("--widths", type=int, nargs="+", default=[1, 2, 3, 4], metavar="PX")
    parser.add_argument("--every", type=int, default=2, help="only every n-th drawing")
    parser.add_argument("--jobs", type=int, default=2, help="parallel processes")
    options = parser.parse_args(argv)
    drawings = pages(options.data)[:: options.every]
    work = {f"{wide} px": [(page, wide) for page in drawings] for wide in options.widths}
    return side_by_side(work, judged, options.jobs)


def judged(work: tuple[JudgedPage, int]) -> Fidelity:
    """Draw, trace and judge one page."""
    page, wide = work
    ink = one_bit(page.true_strokes(), wide)
    return fidelity(ink.astype(np.float32), vectorize(np.where(ink, 0, 255).astype(np.uint8)))


def one_bit(strokes: Sequence[Array], wide: int, side: int = int(LONG_SIDE)) -> Array:
    """(side, side) bool: polylines of so many px, every pixel ink or paper."""
    drawn = np.zeros((side, side), np.uint8)
    # A line by Bresenham, thickened by a round pen: as wide as it says, in every direction.
    for line in strokes:
        fixed = np.rint((np.asarray(line) - 0.5) * 2**_SUB).astype(np.int32)
        cv2.polylines(drawn, [fixed.reshape(-1, 1, 2)], False, 1, 1, cv2.LINE_8, _SUB)
    pen = cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (wide, wide))
    return cv2.dilate(drawn, pen) > 0


if __name__ == "__main__":
    main()
