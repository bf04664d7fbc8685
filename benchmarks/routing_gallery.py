"""Scans before and after the routing network: `python -m benchmarks.routing_gallery SCAN -o OUT`.

For every scan a cut-out, its strokes as routed by geometry, and as routed by the network, each
stroke in a colour of its own; a wrong routing shows as a colour that changes along a line, or that
turns a corner where no pen did.
"""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import cv2
import numpy as np
from involute.engine import Drawing, Settings, vectorize

Array = np.ndarray

_SIDE = 340  # px of a cut-out in the picture
_CUT = 420  # px of a cut-out in the scan


def main(argv: Sequence[str] | None = None) -> None:
    """The command line."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("scans", type=Path, nargs="+")
    parser.add_argument("-o", "--out", type=Path, required=True)
    args = parser.parse_args(argv)
    rows = [row(np.asarray(cv2.imread(str(scan)))) for scan in args.scans]
    half = (len(rows) + 1) // 2
    rows += [np.full_like(rows[0], 255)] * (2 * half - len(rows))
    picture = np.hstack([np.vstack(rows[:half]), np.vstack(rows[half:])])
    cv2.imwrite(str(args.out), picture, [cv2.IMWRITE_JPEG_QUALITY, 88])


def row(scan: Array) -> Array:
    """The darkest cut-out of a scan, and its strokes by geometry and by the network."""
    dark = cv2.boxFilter(255.0 - scan.mean(2), -1, (_CUT, _CUT), normalize=False)
    margin = _CUT // 2
    inner = dark[margin : max(margin + 1, len(dark) - margin), margin : -margin or None]
    top, left = np.unravel_index(int(inner.argmax()), inner.shape)
    cut = np.ascontiguousarray(scan[top : top + _CUT, left : left + _CUT])
    after = vectorize(cut, Settings(router="network"))
    before = replace(after, settings=Settings(router="geometric")).ask_again()
    pictures = (cut, coloured(before), coloured(after))
    return np.hstack([_framed(picture) for picture in pictures])


def coloured(drawing: Drawing) -> Array:
    """A drawing's strokes on white, (H, W, 3) BGR, each in a colour given by its first branch."""
    width, height = drawing.size
    image = np.full((height, width, 3), 255, np.uint8)
    for stroke in drawing.strokes:
        hue = int(stroke.branches.min() >> 1) * 67 % 180
        color = cv2.cvtColor(np.array([[[hue, 230, 190]]], np.uint8), cv2.COLOR_HSV2BGR)[
            0, 0
        ].tolist()
        points = np.round((stroke.points - 0.5) * 16).astype(np.int32)
        cv2.polylines(image, [points], stroke.closed, color, 2, cv2.LINE_AA, 4)
    return image


def _framed(picture: Array) -> Array:
    scale = _SIDE / max(picture.shape[:2])
    small = cv2.resize(picture, None, fx=scale, fy=scale, interpolation=cv2.INTER_AREA)
    down, right = _SIDE - small.shape[0], _SIDE - small.shape[1]
    filled = cv2.copyMakeBorder(small, 0, down, 0, right, cv2.BORDER_CONSTANT, value=[255] * 3)
    return cv2.copyMakeBorder(filled, 2, 2, 2, 2, cv2.BORDER_CONSTANT, value=[210] * 3)


if __name__ == "__main__":
    main()
