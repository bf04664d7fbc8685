"""A contact sheet of 100 synthetic pages, to look at: the ink, and what the network should see.

python -m involute.training.centerline.contact_sheet --data DIR --out sheet.png
"""

from __future__ import annotations

import argparse
from pathlib import Path

import cv2
import numpy as np

from ...synthesis.line_art import Array
from .page_batches import STREAMS


def main(arguments: list[str] | None = None) -> None:
    """The command line."""
    parser = argparse.ArgumentParser(prog="sheet", description=__doc__.splitlines()[0])
    parser.add_argument("--data", type=Path, required=True)
    parser.add_argument("--out", type=Path, required=True)
    parser.add_argument("--pages", default="clean", choices=list(STREAMS))
    parser.add_argument("--count", type=int, default=100)
    parser.add_argument("--size", type=int, default=256)
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args(arguments)
    stream = STREAMS[options.pages]
    library = stream.load(options.data)
    pages = [
        stream.draw(np.random.default_rng((options.seed, k)), library, options.size, False)
        for k in range(options.count)
    ]
    columns = int(np.ceil(np.sqrt(options.count)))
    cells = [show(p) for p in pages]
    cells += [np.zeros_like(cells[0])] * (-len(cells) % columns)
    rows = [np.hstack(cells[k : k + columns]) for k in range(0, len(cells), columns)]
    cv2.imwrite(str(options.out), np.vstack(rows))


def show(maps: Array) -> Array:
    """A page as a picture, BGR: ink, targets (ridges green, junctions blue, ends red, solid areas
    grey), what the lines mean (white; doubled lines red, the farther apart the yellower), and where
    the pen was lifted (red over the ink)."""
    ink = cv2.cvtColor(255 - maps[0], cv2.COLOR_GRAY2BGR)
    seen = np.stack([maps[2], maps[1], maps[3]], -1)
    seen = np.maximum(seen, maps[5][..., None] // 2)
    two = (maps[6] > 200) & (maps[1] > 60)
    means = np.repeat(maps[8][..., None], 3, -1)
    means[two] = np.stack([0 * maps[7], np.minimum(maps[7], 85) * 3, 0 * maps[7] + 255], -1)[two]
    lit = maps[9][..., None] / 255.0
    lifted = ((128 + ink // 2) * (1 - lit) + lit * np.array([0, 0, 230])).astype(np.uint8)
    return np.pad(
        np.hstack([ink, seen, means, lifted]), ((0, 4), (0, 4), (0, 0)), constant_values=128
    )


if __name__ == "__main__":
    main()
