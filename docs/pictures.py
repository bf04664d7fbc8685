"""Makes the README's picture: `python docs/pictures.py`, from the root of the project."""

from __future__ import annotations

from pathlib import Path

import cv2
import numpy as np
from involute.engine import vectorize
from involute.engine.formats import png

ROOT = Path(__file__).resolve().parents[1]
WIDTH = 1600  # px


def before_after(scan: Path, picture: Path) -> None:
    """A scan, and beside it its strokes, each in a colour of its own."""
    before = cv2.imread(str(scan))
    after = png.render(vectorize(scan), rings=False)[..., ::-1]
    rule = np.full((len(before), 4, 3), 200, np.uint8)
    both = np.hstack([before, rule, after])
    scale = WIDTH / both.shape[1]
    both = cv2.resize(both, None, fx=scale, fy=scale, interpolation=cv2.INTER_AREA)
    cv2.imwrite(str(picture), both, [cv2.IMWRITE_PNG_COMPRESSION, 9])


if __name__ == "__main__":
    before_after(ROOT / "examples" / "beasts_p0190a.jpg", ROOT / "docs" / "before_after.png")
