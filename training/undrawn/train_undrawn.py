"""Learn which branches of a traced graph nobody drew, for `engine/graph/removal/undrawn.py`.

`python -m training run undrawn --data DIR --run RUN --pages 600` draws pages of true strokes as
hands draw and scanners see them, traces them with the centerline network, and keeps the features of
every branch beside whether a true stroke made it (RUN/train.npz, RUN/held_out.npz; started again,
it goes on). Then it trains a small network, see `training/loop.py`, and writes
engine/weights/undrawn.npz. The figures are in RUN/log.jsonl.
"""

from __future__ import annotations

import argparse
import json
from collections.abc import Iterator, Sequence
from pathlib import Path

import cv2
import numpy as np
import torch
from involute.engine.graph import Evidence, run_passes
from involute.engine.graph.removal.undrawn import FEATURES, WEIGHTS, features
from involute.engine.graph.topology import lengths
from involute.engine.settings import Settings
from involute.engine.values import PlanarGraph
from involute.synthesis.composed_pages import Library, loosened
from scipy.spatial import cKDTree
from torch import Tensor, nn

from .. import digests, lineage
from ..loop import Schedule, Training
from ..page_bank import Labelled, labelled_rows
from ..routing.labels import labelled, unowned
from ..routing.traced import MOST_FALSE, look_ink, look_scan, on_canvas

Array = np.ndarray

_SCANNED = 0.85  # share of the pages; the others are even ink
_STIPPLED = 0.5  # share of the pages that have dots, too
_APART, _ON = 9.0, 3.0  # px between a dot and what else is drawn; and between it and its trace
_library: Library  # of a process that makes pages, and its
_seed: int
_PIECE = 50  # pages between two writings of the file


def main(argv: Sequence[str] | None = None) -> None:
    """The command line."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--data", type=Path, required=True, help="folder of SOURCE.npz drawings")
    parser.add_argument("--run", type=Path, required=True)
    parser.add_argument("--pages", type=int, default=600)
    parser.add_argument("--jobs", type=int, default=1, help="parallel processes")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--steps", type=int, default=6000)
    parser.add_argument("--out", type=Path, default=WEIGHTS)
    args = parser.parse_args(argv)
    lineage.note_run(args.run, args, torch=torch.__version__)
    parts = {}
    for name, pages in (("train", args.pages), ("held_out", args.pages // 6)):
        work = args.data, name == "held_out", args.seed
        parts[name] = gathered(args.run / f"{name}.npz", pages, args.jobs, work)
    net, figures = train(*parts["train"], *parts["held_out"], args.steps, args.seed, args.run)
    print(json.dumps(figures, indent=1))
    np.savez(args.out, **net)
    digests.note(args.out, args.run)


def gathered(path: Path, pages: int, jobs: int, work: tuple) -> Labelled:
    """Features (N, F) and labels (N,) of the branches of so many pages, from a file or made."""
    return labelled_rows(path, pages, jobs, _branches, _prepare, work, _PIECE)


def _prepare(data: Path, held_out: bool, seed: int) -> None:
    """What every page needs, once in each process."""
    global _library, _seed
    cv2.setNumThreads(1)
    _library, _seed = Library.load(data, held_out), seed


def _branches(number: int) -> Labelled:
    """The branches of one page; none when it is no example."""
    rng, settings = np.random.default_rng((_seed, number)), Settings()
    strokes = on_canvas(loosened(rng, _library.page(rng)))
    dots = _stipple(rng, strokes) if strokes and rng.random() < _STIPPLED else []
    look = look_scan if rng.random() < _SCANNED else look_ink
    if strokes:
        maps, scan = look(rng, strokes + dots, settings)
        evidence = Evidence.of(scan, maps)
        graph = run_passes(evidence, settings, until="undrawn")
        if graph.branch_count:
            page = labelled(graph, [line / scan.scale for line in strokes + dots])
            false = page.stroke[graph.offsets[:-1]] < 0
            false &= ~_on_dots(graph, [dot / scan.scale for dot in dots])
            if unowned(page) < MOST_FALSE:
                return features(graph, evidence).astype(np.float32), false
    return np.zeros((0, FEATURES), np.float32), np.zeros(0, bool)


def _stipple(rng: np.random.Generator, strokes: list[Array]) -> list[Array]:
    """Dots and ticks in a few places between the lines, (2, 2) px each: they are drawn, too."""
    drawn = np.concatenate(strokes)
    dots: list[Array] = []
    for _ in range(int(rng.integers(1, 4))):
        middle, spread = rng.uniform(drawn.min(0), drawn.max(0)), rng.uniform(20, 90)
        for place in rng.normal(middle, spread, (int(rng.integers(8, 50)), 2)):
            apart = np.hypot(*(np.concatenate([drawn, *dots]) - place).T).min()
            inside = (place > drawn.min(0)).all() and (place < drawn.max(0)).all()
            if apart > _APART and inside:
                way = rng.normal(0, 1, 2)
                way *= rng.uniform(0.3, 2.5) / max(np.hypot(*way), 1e-6)
                dots.append(np.stack([place - way, place + way]))
    return dots


def _on_dots(graph: PlanarGraph, dots: list[Array]) -> Array:
    """(B,) bool: small loose pieces that lie on a dot; a dot has no direction to be known by."""
    loose = (graph.degrees[graph.ends] == 1).all(1) & (lengths(graph) < _APART)
    if not dots:
        return np.zeros_like(loose)
    middle = graph.vertices[graph.ends].mean(1)
    away = cKDTree(np.array([dot.mean(0) for dot in dots])).query(middle)[0]
    return loose & (away < _ON)


def train(
    rows: Array,
    labels: Array,
    held_rows: Array,
    held_labels: Array,
    steps: int,
    seed: int,
    folder: Path,
) -> tuple[dict[str, Array], dict[str, object]]:
    """Weights as `engine/graph/removal/undrawn.py` reads them, and figures on held-out branches."""
    torch.manual_seed(seed)
    mean, spread = rows.mean(0), rows.std(0) + 1e-3
    net = nn.Sequential(
        nn.Linear(rows.shape[1], 48), nn.ReLU(), nn.Dropout(0.1),
        nn.Linear(48, 24), nn.ReLU(), nn.Linear(24, 1),
    )  # fmt: skip
    schedule = Schedule(steps, rate=3e-3, least=0.0, every=steps)
    training = Training(folder, net, schedule, weight_decay=0.02)
    held = torch.from_numpy((held_rows - mean) / spread)
    counts: dict[str, object] = {
        "branches": len(rows), "undrawn": int(labels.sum()),
        "held-out branches": len(held), "held-out undrawn": int(held_labels.sum()),
    }  # fmt: skip
    x, y = (torch.from_numpy(a) for a in ((rows - mean) / spread, labels.astype(np.float32)))
    training.run(_batches(x, y), _loss, lambda net: counts | _figures(net, held, held_labels))
    weights = {"mean": mean, "spread": spread}
    for number, layer in enumerate(m for m in training.mean if isinstance(m, nn.Linear)):
        weights[f"weight{number}"] = layer.weight.detach().numpy().T.copy()
        weights[f"bias{number}"] = layer.bias.detach().numpy()
    figures = counts | _figures(training.mean, held, held_labels)
    return {name: np.asarray(value, np.float32) for name, value in weights.items()}, figures


def _batches(x: Tensor, y: Tensor) -> Iterator[tuple[Tensor, Tensor]]:
    while True:
        pick = torch.randint(len(x), (1024,))
        # A little noise, so that it does not learn single branches by heart.
        yield x[pick] + 0.1 * torch.randn(len(pick), x.shape[1]), y[pick]


def _loss(net: nn.Module, batch: tuple[Tensor, Tensor]) -> dict[str, Tensor]:
    seen, truth = batch
    return {"total": nn.functional.binary_cross_entropy_with_logits(net(seen)[:, 0], truth)}


@torch.no_grad()
def _figures(net: nn.Module, held: Tensor, undrawn: Array) -> dict[str, object]:
    """What each limit would take away on held-out branches, and how much of that rightly."""
    stated = torch.sigmoid(net(held))[:, 0].numpy()
    figures: dict[str, object] = {}
    for limit in (0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9):
        goes = stated > limit
        right = int((goes & undrawn).sum())
        figures[f"above {limit}"] = {
            "found": round(right / max(1, int(undrawn.sum())), 3),
            "right": round(right / max(1, int(goes.sum())), 3),
            "drawn lost": round(float((goes & ~undrawn).sum() / max(1, (~undrawn).sum())), 5),
        }
    return figures


if __name__ == "__main__":
    main()
