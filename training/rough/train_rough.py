"""Learn how many pencil strokes become one line, for `engine/rough`.

`python -m training run rough --data DIR --run RUN --pages 200` draws and traces pages
(`rough_pages`; RUN/train and RUN/held_out, started again it goes on) and trains seven small
networks, one on what the other leaves: which strokes mean one line (on any page, and on rough
ones), whether a page is rough, which redrawn lines are meant, which go on over gaps, and which in
which where they meet, in two looks. It writes engine/weights/rough.npz; the held-out pages choose
when to stop. The figures go to RUN/log.json.
"""

from __future__ import annotations

import argparse
import json
from collections.abc import Sequence
from pathlib import Path

import numpy as np
import torch
from involute.engine.graph.topology import join, select
from involute.engine.rough import bridging, cleaning, grouping, meant, sampled, telling
from involute.engine.rough.redrawn import Bundles
from involute.engine.settings import Settings
from involute.engine.values import PlanarGraph
from involute.synthesis.composed_pages import Library

from .. import digests, lineage
from . import true_lines
from .fitting import Net, Rows, fitted, none, stacked
from .meetings import Meetings, second_rows
from .rough_pages import RoughPage, gathered, rough_page
from .true_lines import TrueLines

Array = np.ndarray

_HIDDEN = {
    "tells": (32, 16),
    "same": (32, 16),
    "rough_page": (16,),
    "meant": (32, 16),
    "bridges": (24, 12),
    "goes_on": (64, 32),
    "goes_on_again": (64, 32),
}
_LEFT = 0.35  # share of the false branches that a first look leaves


def main(argv: Sequence[str] | None = None) -> None:
    """The command line."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--data", type=Path, required=True, help="folder of SOURCE.npz drawings")
    parser.add_argument("--run", type=Path, required=True)
    parser.add_argument("--pages", type=int, default=200, help="to learn from")
    parser.add_argument("--held-out", type=int, default=64, help="pages that choose when to stop")
    parser.add_argument("--steps", type=int, default=1500)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--out", type=Path, default=grouping.WEIGHTS)
    args = parser.parse_args(argv)
    lineage.note_run(args.run, args, torch=torch.__version__)
    torch.manual_seed(args.seed)
    torch.set_num_threads(1)
    parts = [
        _pages(args.run, *part, args.data, args.seed)
        for part in (("train", args.pages, False), ("held_out", args.held_out, True))
    ]
    net, figures = learnt(*parts, args.steps)
    print(json.dumps(figures, indent=1))
    (args.run / "log.json").write_text(json.dumps(figures, indent=1), "utf-8")
    np.savez(args.out, **net)
    digests.note(args.out, args.run)


def _pages(run: Path, name: str, pages: int, held: bool, data: Path, seed: int) -> list[RoughPage]:
    library = Library.load(data, held)

    def make(rng: np.random.Generator, number: int) -> RoughPage | None:
        return rough_page(rng, library, number, each=held)

    return gathered(run / name, pages, make, seed)


def learnt(
    pages: list[RoughPage], held: list[RoughPage], steps: int
) -> tuple[Net, dict[str, object]]:
    """The weights of all networks, and figures on the held-out pages."""
    net: Net = {}
    figures: dict[str, object] = {"pages": len(pages), "held-out pages": len(held)}

    def fit(name: str, rows: list[Rows], judged: list[Rows]) -> Net:
        found, figures[name] = fitted(stacked(rows), stacked(judged), _HIDDEN[name], steps)
        print(name, figures[name], flush=True)
        return {f"{name}_{k}": v for k, v in found.items()}

    def learn(name: str, rows: list[Rows], judged: list[Rows]) -> None:
        net.update(fit(name, rows, judged))

    learn("tells", *([stretches(page) for page in some] for some in (pages, held)))
    learn("rough_page", *([page_row(page, _wide(net)) for page in some] for some in (pages, held)))
    # On a page that is known to be rough, more means one line than anywhere.
    pages, held = ([page for page in some if page.spread > 0] for some in (pages, held))
    learn("same", *([stretches(page) for page in some] for some in (pages, held)))
    learn("meant", *([branch_rows(page, _wide(net)) for page in some] for some in (pages, held)))
    left = [[left_rows(page, _wide(net)) for page in some] for some in (pages, held)]
    learn("bridges", *([ends for ends, _ in some] for some in left))
    meet, judged = ([one for _, met in some for one in met] for some in left)
    held_rows = [one.first for one in judged]
    again = second_rows(meet, lambda rows: fit("goes_on", rows, held_rows))
    learn("goes_on", [one.first for one in meet], held_rows)
    learn("goes_on_again", again, [one.second(net) for one in judged])
    return net, figures


def stretches(page: RoughPage) -> Rows:
    """Features and labels of the stretches of one page."""
    found = cleaning.beside_each_other(page.graph, page.partner, page.ink.shape)
    if not len(found.rungs.a):
        return none(grouping.FEATURES)
    ink = page.ink.astype(np.float32) / 255
    rows = grouping.features(found.strokes, found.rungs, ink, found.pen)
    true = TrueLines.of(page.lines)
    reach = sampled.reach_of(found.pen)
    label = true_lines.one_line(found.strokes, found.rungs, true, page.spread, reach)
    known = label != true_lines.UNKNOWN
    return rows[known], label[known]


def page_row(page: RoughPage, net: Net) -> Rows:
    """What tells whether a page is rough, and whether it is."""
    found = cleaning.beside_each_other(page.graph, page.partner, page.ink.shape)
    if not len(found.rungs.a):
        return none(telling.FEATURES)
    ink = page.ink.astype(np.float32) / 255
    rows = grouping.features(found.strokes, found.rungs, ink, found.pen)
    told = grouping.probability(rows, "tells", net)[found.rungs.stretch]
    signs = telling.Signs.of(found.strokes, found.rungs, told, page.graph, found.pen)
    return signs.row, np.array([page.spread > 0])


def _wide(net: Net) -> Net:
    return {k: v.astype(np.float64) for k, v in net.items()}


def branch_rows(page: RoughPage, net: Net) -> Rows:
    """Features and labels of the branches that are redrawn: is each of them meant?"""
    found, bundles, graph = _redrawn(page, net)
    true = TrueLines.of(page.lines)
    branches: list[Rows] = [none(meant.FEATURES)]
    rng = np.random.default_rng(0)
    for left in (_LEFT, 0.0, 0.0):  # as they are, with some false ones, and without
        if graph.branch_count < 2:
            break
        label = true_lines.meant(graph, true, page.spread)
        branches.append((meant.features(graph, bundles, found.pen), label))
        graph = join(select(graph, label | (rng.random(len(label)) < left)))
    return stacked(branches)


def left_rows(page: RoughPage, net: Net) -> tuple[Rows, list[Meetings]]:
    """Features and labels of the loose ends of what is meant, and where its lines meet when gaps
    are closed: of what is meant in truth, and of what the network takes for it."""
    found, bundles, redrawn = _redrawn(page, net)
    true = TrueLines.of(page.lines)
    ends, met = [none(bridging.FEATURES)], []
    for graph in (
        _truly_meant(redrawn, true, page.spread),
        meant.meant_lines(redrawn, bundles, found.pen, net),
    ):
        if graph.branch_count < 2:
            continue
        halves = bridging.candidates(graph, found.pen)
        gaps = true_lines.goes_on(graph, halves, true, page.spread)
        ends.append((bridging.features(graph, halves, bundles, found.pen), gaps))
        whole = bridging.closed(graph, true_lines.nearest_first(graph, halves[gaps]))
        met.append(Meetings.of(whole, page, bundles))
    return stacked(ends), [one for one in met if one is not None]


def _redrawn(page: RoughPage, net: Net) -> tuple[cleaning.Bundled, Bundles, PlanarGraph]:
    ink = page.ink.astype(np.float32) / 255
    found = cleaning.bundled(page.graph, page.partner, ink, net)
    return found, *cleaning.redrawn(found, Settings(), page.ink.shape)


def _truly_meant(graph: PlanarGraph, true: TrueLines, spread: float) -> PlanarGraph:
    for _ in range(2):  # what hung on something that went is looked at again
        if graph.branch_count:
            graph = join(select(graph, true_lines.meant(graph, true, spread)))
    return graph


if __name__ == "__main__":
    main()
