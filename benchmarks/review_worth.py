"""What a review is worth: `python -m benchmarks run review --data FOLDER`, on traced pages.

FOLDER has pages with their true strokes (`python -m synthesis.held_out_pages`). How many junctions
are flagged; how sure the routing is of itself, against how often it is right; and which share of
the wrong length of strokes the first 30 decisions find, by cost and by plain doubt.
"""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from involute.engine import Drawing, vectorize
from involute.engine.routing.cost import lengths_beyond
from involute.training.routing.judge import calibration_error
from involute.training.routing.labels import labelled

from .judged_pages import DATA, JudgedPage, pages
from .run_record import Figures

Array = np.ndarray

_DECISIONS = 30
_LONG_SIDE = 1024.0  # px of a page's true strokes


@dataclass(frozen=True, eq=False)
class Reviewed:
    """The junctions of some pages, all arrays (J,).

    right: is the routing in force the true one; wrong: px of stroke that it leads wrong.
    by_cost, by_doubt: the place of a junction in its page's list.
    """

    doubt: Array
    flagged: Array
    right: Array
    wrong: Array
    by_cost: Array
    by_doubt: Array

    @staticmethod
    def joined(parts: Sequence[Reviewed]) -> Reviewed:
        """The junctions of several pages in a row."""
        names = Reviewed.__dataclass_fields__
        return Reviewed(**{n: np.concatenate([getattr(p, n) for p in parts]) for n in names})

    def figures(self) -> dict[str, float]:
        """Shares, and the calibration error."""
        total = max(float(self.wrong.sum()), 1e-9)
        return {
            "junctions": float(len(self.doubt)),
            "right": float(self.right.mean()),
            "flagged": float(self.flagged.mean()),
            "calibration error": calibration_error(1.0 - self.doubt, self.right),
            "wrong length flagged": float(self.wrong[self.flagged].sum()) / total,
            "found by cost": float(self.wrong[self.by_cost < _DECISIONS].sum()) / total,
            "found by doubt": float(self.wrong[self.by_doubt < _DECISIONS].sum()) / total,
        }


def main(argv: Sequence[str] | None = None) -> Figures:
    """Trace the pages and print the figures of all, and of those with more junctions than that."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--data", type=Path, default=DATA, help="folder with a manifest.json")
    parser.add_argument("--pages", type=int, help="only the first so many")
    args = parser.parse_args(argv)
    found = [reviewed(page) for page in pages(args.data)[: args.pages]]
    found = [page for page in found if len(page.doubt)]
    large = [page for page in found if len(page.doubt) > _DECISIONS]
    rows = {"all pages": found, f"more than {_DECISIONS} junctions": large}
    figures = {
        f"{name} ({len(some)})": Reviewed.joined(some).figures()
        for name, some in rows.items()
        if some
    }
    for name, values in figures.items():
        print(name, *(f"  {what:22} {value:8.3f}" for what, value in values.items()), sep="\n")
    return figures


def reviewed(page: JudgedPage) -> Reviewed:
    """The junctions of one page as it is traced."""
    drawing = vectorize(page.image)
    scale = max(drawing.size) / _LONG_SIDE
    true = labelled(drawing.graph, [line * scale for line in page.true_strokes()]).partner
    wrong = wrong_lengths(drawing, true)
    doubt = np.array([junction.doubt for junction in drawing.junctions])
    flagged = np.zeros(len(doubt), bool)
    flagged[list(drawing.doubtful)] = True
    orders = drawing.costs[: len(doubt)], doubt
    places = [np.argsort(np.argsort(-order, kind="stable")) for order in orders]
    return Reviewed(doubt, flagged, wrong == 0, wrong, *places)


def wrong_lengths(drawing: Drawing, true: Array) -> Array:
    """(J,) px of stroke that each junction leads wrong; the longest part of it stays in place.

    Args:
        true: (2B,) in which half-branch each one truly continues, itself where it ends.
    """
    beyond = lengths_beyond(drawing.graph, drawing.strokes)
    made = drawing.routing.partner
    found = []
    for junction in drawing.junctions:
        halves = np.array(junction.half_branches)
        parts = beyond[halves[made[halves] != true[halves]]]
        found.append(parts.sum() - parts.max(initial=0.0))
    return np.array(found, float)


if __name__ == "__main__":
    main()
