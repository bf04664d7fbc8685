"""Learn how many pencil strokes become one line, for `engine/rough`.

`python -m training run rough --data DIR --run RUN --pages 200` draws and traces pages
(`rough_pages`; RUN/train and RUN/held_out, started again it goes on) and trains five small
networks, one on what the other leaves: which strokes mean one line (on any page, and on rough
ones), which redrawn lines are meant, which go on over gaps, and which in which where they meet. It
writes engine/weights/rough.npz; the held-out pages choose when to stop. The figures go to
RUN/log.json.
"""

from __future__ import annotations

import argparse
import json
from collections.abc import Sequence
from itertools import pairwise
from pathlib import Path

import numpy as np
import torch
from involute.engine.graph.topology import join, select
from involute.engine.rough import bridging, cleaning, continuing, grouping, meant, sampled
from involute.engine.rough.redrawn import Bundles
from involute.engine.routing.candidates import candidate_pairs
from involute.engine.settings import Settings
from involute.engine.values import PlanarGraph
from involute.synthesis.composed_pages import Library
from torch import nn

from .. import digests, lineage
from ..routing import labels
from . import true_lines
from .rough_pages import RoughPage, gathered, rough_page
from .true_lines import TrueLines

Array = np.ndarray
Rows = tuple[Array, Array]
Net = dict[str, Array]

_HIDDEN = {
    "tells": (32, 16),
    "same": (32, 16),
    "meant": (32, 16),
    "bridges": (24, 12),
    "goes_on": (48, 24),
}
_BATCH, _NOISE, _DROPOUT = 1024, 0.1, 0.2
_EVERY = 75  # steps between two looks at the held-out pages
_LEFT = 0.35  # share of the false branches that a first look leaves
_NEAR = (3.5, 1.5)  # px, and times the spread, that a redrawn line may lie off the stroke it is


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

    def learn(name: str, rows: list[Rows], judged: list[Rows]) -> None:
        found, figure = fitted(_stacked(rows), _stacked(judged), _HIDDEN[name], steps)
        net.update({f"{name}_{k}": v for k, v in found.items()})
        figures[name] = figure
        print(name, figure, flush=True)

    learn("tells", *([stretches(page) for page in some] for some in (pages, held)))
    # On a page that is known to be rough, more means one line than anywhere.
    pages, held = ([page for page in some if page.spread > 0] for some in (pages, held))
    learn("same", *([stretches(page) for page in some] for some in (pages, held)))
    learn("meant", *([branch_rows(page, _wide(net)) for page in some] for some in (pages, held)))
    left = [[left_rows(page, _wide(net)) for page in some] for some in (pages, held)]
    for number, name in enumerate(("bridges", "goes_on")):
        learn(name, *([one[number] for one in some] for some in left))
    return net, figures


def stretches(page: RoughPage) -> Rows:
    """Features and labels of the stretches of one page."""
    found = cleaning.beside_each_other(page.graph, page.partner, page.ink.shape)
    if not len(found.rungs.a):
        return _none(grouping.FEATURES)
    ink = page.ink.astype(np.float32) / 255
    rows = grouping.features(found.strokes, found.rungs, ink, found.pen)
    true = TrueLines.of(page.lines)
    reach = sampled.reach_of(found.pen)
    label = true_lines.one_line(found.strokes, found.rungs, true, page.spread, reach)
    known = label != true_lines.UNKNOWN
    return rows[known], label[known]


def _wide(net: Net) -> Net:
    return {k: v.astype(np.float64) for k, v in net.items()}


def branch_rows(page: RoughPage, net: Net) -> Rows:
    """Features and labels of the branches that are redrawn: is each of them meant?"""
    found, bundles, graph = _redrawn(page, net)
    true = TrueLines.of(page.lines)
    branches: list[Rows] = [_none(meant.FEATURES)]
    rng = np.random.default_rng(0)
    for left in (_LEFT, 0.0, 0.0):  # as they are, with some false ones, and without
        if graph.branch_count < 2:
            break
        label = true_lines.meant(graph, true, page.spread)
        branches.append((meant.features(graph, bundles, found.pen), label))
        graph = join(select(graph, label | (rng.random(len(label)) < left)))
    return _stacked(branches)


def left_rows(page: RoughPage, net: Net) -> tuple[Rows, Rows]:
    """Features and labels of the loose ends of what is meant, and of its pairs where gaps are
    closed: of what is meant in truth, and of what the network takes for it."""
    found, bundles, redrawn = _redrawn(page, net)
    true = TrueLines.of(page.lines)
    ends, pairs = [_none(bridging.FEATURES)], [_none(continuing.FEATURES)]
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
        pairs.append(_pairs(whole, page, bundles))
    return _stacked(ends), _stacked(pairs)


def _redrawn(page: RoughPage, net: Net) -> tuple[cleaning.Bundled, Bundles, PlanarGraph]:
    ink = page.ink.astype(np.float32) / 255
    found = cleaning.bundled(page.graph, page.partner, ink, net)
    return found, *cleaning.redrawn(found, Settings(), page.ink.shape)


def _truly_meant(graph: PlanarGraph, true: TrueLines, spread: float) -> PlanarGraph:
    for _ in range(2):  # what hung on something that went is looked at again
        if graph.branch_count:
            graph = join(select(graph, true_lines.meant(graph, true, spread)))
    return graph


def _pairs(graph: PlanarGraph, page: RoughPage, bundles: Bundles) -> Rows:
    none = _none(continuing.FEATURES)
    if graph.branch_count < 2:
        return none
    pairs = candidate_pairs(graph)
    pairs = pairs[graph.degrees[graph.half_vertex[pairs[:, 0]]] >= 3]
    if not len(pairs):
        return none
    least, strays = _NEAR
    truth = labels.labelled(graph, page.lines, max(least, strays * page.spread))
    owned = truth.stroke[graph.offsets[:-1]] >= 0
    known = owned[pairs >> 1].any(1)  # what is left of no line goes on in none
    label = np.asarray(truth.partner)[pairs[:, 0]] == pairs[:, 1]
    return continuing.features(graph, pairs, bundles)[known], label[known]


def _none(features: int) -> Rows:
    return np.zeros((0, features)), np.zeros(0, bool)


def _stacked(parts: list[Rows]) -> Rows:
    return np.concatenate([p[0] for p in parts]), np.concatenate([p[1] for p in parts])


def fitted(
    rows: Rows, held: Rows, hidden: tuple[int, ...], steps: int
) -> tuple[Net, dict[str, float]]:
    """A perceptron that is best on the held-out rows, as `engine.rough.grouping` reads it."""
    mean, spread = rows[0].mean(0), rows[0].std(0) + 1e-3

    def tensors(part: Rows) -> tuple[torch.Tensor, torch.Tensor]:
        scaled = np.clip((part[0] - mean) / spread, -4, 4).astype(np.float32)
        return torch.from_numpy(scaled), torch.from_numpy(part[1].astype(np.float32))

    (x, y), (held_x, held_y) = tensors(rows), tensors(held)
    layers: list[nn.Module] = []
    sizes = [x.shape[1], *hidden]
    for a, b in pairwise(sizes):
        layers += [nn.Linear(a, b), nn.ReLU(), nn.Dropout(_DROPOUT)]
    net = nn.Sequential(*layers, nn.Linear(sizes[-1], 1))
    optimizer = torch.optim.AdamW(net.parameters(), lr=3e-3, weight_decay=0.05)
    plan = torch.optim.lr_scheduler.OneCycleLR(optimizer, 3e-3, total_steps=steps)
    lost = nn.functional.binary_cross_entropy_with_logits
    best, kept = np.inf, net.state_dict()
    for step in range(steps):
        pick = torch.randint(len(x), (_BATCH,))
        loss = lost(net(x[pick] + _NOISE * torch.randn(_BATCH, x.shape[1]))[:, 0], y[pick])
        optimizer.zero_grad()
        loss.backward()
        optimizer.step()
        plan.step()
        if step % _EVERY == _EVERY - 1 or step == steps - 1:
            net.eval()
            with torch.no_grad():
                judged = float(lost(net(held_x)[:, 0], held_y))
            net.train()
            if judged < best:
                best, kept = judged, {k: v.clone() for k, v in net.state_dict().items()}
    net.load_state_dict(kept)
    net.eval()
    with torch.no_grad():
        right = ((net(held_x)[:, 0] > 0) == (held_y > 0.5)).float().mean()
    figure = {
        "rows": len(x),
        "held-out rows": len(held_x),
        "true": round(float(held_y.mean()), 3),
        "loss": round(best, 4),
        "right": round(float(right), 4),
    }
    found = {"mean": mean, "spread": spread}
    for number, layer in enumerate(m for m in net if isinstance(m, nn.Linear)):
        found[f"weight{number}"] = layer.weight.detach().numpy().T
        found[f"bias{number}"] = layer.bias.detach().numpy()
    return {name: np.ascontiguousarray(v, np.float32) for name, v in found.items()}, figure


if __name__ == "__main__":
    main()
