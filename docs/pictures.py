"""Makes the README's picture: `python docs/pictures.py`, from the root of the project."""

from __future__ import annotations

from pathlib import Path

import cv2
import numpy as np
from involute.engine import vectorize
from involute.engine.formats import png

ROOT = Path(__file__).resolve().parents[1]


def before_after(scan: Path, picture: Path, part: tuple[slice, slice]) -> None:
    """A part of a scan, and below it its strokes, each in a colour of its own."""
    before = cv2.imread(str(scan))
    after = png.render(vectorize(scan), rings=False)[..., ::-1]
    rule = np.full((2, before[part].shape[1], 3), 200, np.uint8)
    both = np.vstack([before[part], rule, after[part]])
    cv2.imwrite(str(picture), both, [cv2.IMWRITE_PNG_COMPRESSION, 9])


if __name__ == "__main__":
    before_after(
        ROOT / "examples" / "hippopotamus.jpg",
        ROOT / "docs" / "before_after.png",
        (slice(160, 730), slice(60, 1300)),
    )
