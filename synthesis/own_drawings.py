"""Your own vector drawings as a set to train on: `own.npz`, beside the public ones.

    python -m involute.synthesis.own_drawings FOLDER --out DATA

FOLDER holds SVG files in which one path is one pen stroke; fills hide what lies below them.
"""

from __future__ import annotations

import argparse
from pathlib import Path
from xml.etree import ElementTree

import shapely

from .artwork import Array
from .rebuild import Source, drawing, write

NAME = "own"


def read(folder: Path) -> tuple[dict[str, list[Array]], list[str]]:
    """The drawings of a folder and of those in it, by name: (N, 2) px in a box of 1024 for each
    stroke; and the names of files without strokes."""
    drawings: dict[str, list[Array]] = {}
    left_out = []
    for path in sorted(folder.rglob("*.svg")):
        name = path.relative_to(folder).with_suffix("").as_posix()
        try:
            strokes = drawing(path.read_text("utf-8"))
        except (OSError, ElementTree.ParseError, ValueError, shapely.errors.GEOSException):
            strokes = []
        if strokes:
            drawings[name] = strokes
        else:
            left_out.append(name)
    return drawings, left_out


def main(arguments: list[str] | None = None) -> None:
    """The command line."""
    parser = argparse.ArgumentParser(prog="own_drawings", description=__doc__.splitlines()[0])
    parser.add_argument("folder", type=Path)
    parser.add_argument("--out", type=Path, required=True, help="the folder of the sets")
    parser.add_argument("--licence", default="not published", help="noted beside the set")
    options = parser.parse_args(arguments)
    drawings, left_out = read(options.folder)
    for name in left_out:
        print(f"{name}.svg: no strokes in it; left out")
    if not drawings:
        raise SystemExit(f"No drawings in {options.folder}: it must hold SVG files with strokes.")
    options.out.mkdir(parents=True, exist_ok=True)
    source = Source("own drawings", options.licence, "", lambda _: iter(()))
    write(options.out / f"{NAME}.npz", source, drawings)
    strokes = sum(len(d) for d in drawings.values())
    print(f"{NAME}: {len(drawings)} drawings, {strokes} strokes")


if __name__ == "__main__":
    main()
