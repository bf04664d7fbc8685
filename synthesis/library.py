"""The drawings that everything is trained and chosen on, and the one split between the two.

A set is SET.npz (points, stroke_offsets, drawing_offsets, scale) beside SET.json (names and where
it comes from). Which side a drawing is on follows from its name alone: it is the same for every
training, every held-out page and every limit, and stays when sets are added. Variants of one
drawing ("smiley 1", "smiley 2") are one family and always on one side; so are copies by any name.
"""

from __future__ import annotations

import json
import re
from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property
from hashlib import sha256
from itertools import pairwise
from pathlib import Path

import numpy as np

Array = np.ndarray

BOX = 1024  # px; the longer side of a drawing
SHARE = 12  # one family in so many is held out
_CODE = re.compile(r"^[0-9A-F]{4}[0-9A-F-]* ")  # of an emoji
_SEED = re.compile(r":\d+$")  # of a generator: every number is another drawing
_PEOPLE = {"man", "men", "woman", "women", "person", "people", "boy", "girl", "child", "adult"}


def family(title: str) -> str:
    """What the variants of one drawing have in common: its name without numbers, without who does
    it ("man", "woman"), and of icons ("set:file-lock") the first word alone."""
    if _SEED.search(title):
        return title
    bare = _CODE.sub("", title).split(": ")[0].removesuffix(".svg")
    source, _, name = bare.rpartition(":")
    words = [w for w in re.split(r"[-_ \d]+", name.lower()) if len(w) > 1 or not w.isascii()]
    words = words[:1] if source else words
    kept = [word for word in words if word not in _PEOPLE] or words
    return f"{source}:{' '.join(kept)}"


def is_held_out(set_name: str, title: str) -> bool:
    """Whether a drawing is kept to choose and calibrate on: no network is trained on it."""
    # Both Quick, Draw! sets come out of one collection: "quickdraw_raw", "quickdraw_simplified".
    key = f"{set_name.split('_')[0]}/{family(title)}"
    return int(sha256(key.encode()).hexdigest()[:8], 16) % SHARE == 0


@dataclass(frozen=True, eq=False)
class DrawingSet:
    """One set; drawing d holds strokes drawing_offsets[d:d + 1], stroke s points
    stroke_offsets[s:s + 1]. points: (N, 2) float32 px in a box of 1024; held_out: (D,) bool."""

    name: str
    titles: tuple[str, ...]
    points: Array
    stroke_offsets: Array
    drawing_offsets: Array

    @staticmethod
    def read(path: Path) -> DrawingSet:
        """A set from SET.npz; without names beside it, its drawings go by their number."""
        with np.load(path) as packed:
            points = packed["points"].astype(np.float32) * float(packed["scale"])
            strokes = packed["stroke_offsets"].astype(np.int64)
            drawings = packed["drawing_offsets"].astype(np.int64)
        about = path.with_suffix(".json")
        titles = json.loads(about.read_text("utf-8")).get("names", []) if about.exists() else []
        numbered = [f":{number}" for number in range(len(drawings) - 1)]
        return DrawingSet(path.stem, tuple(titles or numbered), points, strokes, drawings)

    def __len__(self) -> int:
        return len(self.drawing_offsets) - 1

    @cached_property
    def held_out(self) -> Array:
        """Which side each drawing is on: by its name, but copies of one that is trained on are
        trained on, too, whatever they are called."""
        named = np.array([is_held_out(self.name, title) for title in self.titles])
        contents = np.array([self._content(number) for number in range(len(self))])
        return named & ~np.isin(contents, contents[~named])

    def _content(self, number: int) -> bytes:
        """What tells one drawing from another: the digest of its points."""
        first, last = self.stroke_offsets[self.drawing_offsets[number : number + 2]]
        return sha256(self.points[first:last].tobytes()).digest()

    def part(self, held_out: bool) -> Array:
        """The numbers of the drawings on one side of the split."""
        return np.flatnonzero(self.held_out == held_out)

    def strokes(self, number: int) -> list[Array]:
        """One drawing: (N, 2) float32 px for each pen stroke."""
        first, last = self.drawing_offsets[number : number + 2]
        cuts = self.stroke_offsets[first : last + 1]
        return [self.points[a:b] for a, b in pairwise(cuts)]


def read_sets(folder: Path | str, names: Iterable[str]) -> dict[str, DrawingSet]:
    """Those of the named sets that the folder holds.

    Raises:
        FileNotFoundError: it holds none of them.
    """
    paths = {name: Path(folder) / f"{name}.npz" for name in names}
    sets = {name: DrawingSet.read(path) for name, path in paths.items() if path.exists()}
    if not sets:
        raise FileNotFoundError(f"No drawings (SET.npz) in {folder}.")
    return sets
