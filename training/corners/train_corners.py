"""Learn at which corners the pen was lifted, for `engine/routing/lifting.py`.

`python -m training run corners --data DIR --run RUN --pages 800` draws and traces pages with the
lifts of many hands (`lift_pages`; RUN/train.npz and RUN/held_out.npz, started again it goes on),
trains a small network in a minute and writes engine/weights/corners.npz; the held-out pages choose
when to stop. With `--start engine/weights/corners.npz` the network that ships is trained on. The
figures go to RUN/log.json.
"""

from __future__ import annotations

import argparse
import json
from collections.abc import Sequence
from itertools import pairwise
from pathlib import Path

import numpy as np
import torch
from involute.engine.graph.clues import WEIGHTS
from torch import nn

from .. import digests, lineage
from .lift_pages import UNKNOWN, Corners, gathered

Array = np.ndarray
Tensor = torch.Tensor

CLUES = 8  # numbers that are kept of each corner
_SEE, _JUDGE = (192,), (64,)  # widths of the hidden layers
_PAGES = 24  # pages of a batch
_DECIDED = 0.3  # share of the pages on which a user has decided some corners
# What a page shows is moved alike at all its corners, in spreads of each number; those that are of
# the whole page, the last of the evidence, by more: else the pages are learnt by heart.
_MOVED, _PAGE_MOVED, _OF_PAGE = 0.2, 0.5, 15


class Lifts(nn.Module):
    """The two rounds: what a corner shows, and what it means on its page."""

    def __init__(self, mean: Tensor, spread: Tensor, dropout: float) -> None:
        super().__init__()
        self.register_buffer("mean", mean)
        self.register_buffer("spread", spread)
        self.see = _layers([len(mean), *_SEE, CLUES], dropout)
        self.judge = _layers([3 * CLUES + 2, *_JUDGE, 1], 0.0)

    def clues(self, evidence: Tensor) -> Tensor:
        return torch.tanh(self.see(((evidence - self.mean) / self.spread).clamp(-5, 5)))

    def forward(self, evidence: Tensor, page: Tensor, decided: Tensor) -> tuple[Tensor, Tensor]:
        """Log-odds of going on: with the page, (N,), and by the corner alone (its first clue)."""
        clues = self.clues(evidence)
        about = _about(clues, page, decided)
        rows = torch.cat([clues, about[page]], 1)
        return self.judge(rows)[:, 0], 4 * clues[:, 0]


def _about(clues: Tensor, page: Tensor, decided: Tensor) -> Tensor:
    """What `engine.routing.lifting.page_of` makes, for many pages at once."""
    pages = int(page.max()) + 1

    def total(values: Tensor) -> Tensor:
        return torch.zeros(pages, values.shape[1]).index_add_(0, page, values)

    number = total(torch.ones_like(clues[:, :1])).clamp(min=1)
    mean = total(clues) / number
    spread = (total((clues - mean[page]) ** 2) / number + 1e-9).sqrt()
    count, said = total(decided.abs()[:, None]), total(decided[:, None])
    return torch.cat(
        [
            mean,
            spread,
            said / (count + 1),
            count / (count + 3),
        ],
        1,
    )


def _layers(sizes: list[int], dropout: float) -> nn.Sequential:
    layers: list[nn.Module] = []
    for a, b in pairwise(sizes):
        layers += [nn.Linear(a, b), nn.ReLU(), nn.Dropout(dropout)]
    return nn.Sequential(*layers[:-2])


def weights(model: Lifts) -> dict[str, Array]:
    """The network as `engine.graph.clues` reads it."""
    found = {"mean": model.mean.numpy(), "spread": model.spread.numpy()}
    for name in ("see", "judge"):
        linear = [layer for layer in getattr(model, name) if isinstance(layer, nn.Linear)]
        for k, layer in enumerate(linear):
            found[f"{name}_weight{k}"] = layer.weight.detach().numpy().T
            found[f"{name}_bias{k}"] = layer.bias.detach().numpy()
    return {name: np.ascontiguousarray(value, np.float32) for name, value in found.items()}


def untrained(data: Corners, dropout: float) -> Lifts:
    """A new network for such evidence."""
    evidence = torch.from_numpy(data.evidence.astype(np.float32))
    return Lifts(evidence.mean(0), evidence.std(0).clamp(min=0.02), dropout)


def restored(path: Path, dropout: float) -> Lifts:
    """The network whose weights are in a file, to be trained on; where it is narrower than those
    of today, it gets units that nothing hears yet."""
    with np.load(path) as file:
        saved = {name: torch.from_numpy(file[name]) for name in file.files}
    model = Lifts(saved["mean"], saved["spread"], dropout)
    for name in ("see", "judge"):
        linear = [layer for layer in getattr(model, name) if isinstance(layer, nn.Linear)]
        for k, layer in enumerate(linear):
            weight, bias = saved[f"{name}_weight{k}"].T, saved[f"{name}_bias{k}"]
            units, heard = weight.shape
            layer.weight.data[:, heard:] = 0
            layer.weight.data[:units, :heard] = weight
            layer.bias.data[:units] = bias
    return model


def train(model: Lifts, data: Corners, held: Corners, steps: int, rate: float, seed: int) -> Lifts:
    """The weights that are best on the held-out pages, those it is given among them."""
    rng = np.random.default_rng(seed)
    evidence, truth = torch.from_numpy(data.evidence.astype(np.float32)), data.truth
    optimizer = torch.optim.AdamW(model.parameters(), lr=rate, weight_decay=0.1)
    plan = torch.optim.lr_scheduler.OneCycleLR(optimizer, rate, total_steps=steps)
    order = np.argsort(data.page, kind="stable")
    bounds = np.searchsorted(data.page[order], np.arange(len(data.habit) + 1))
    full = np.flatnonzero(np.diff(bounds) > 0)
    kept = _copied(model)
    best = figures(model.eval(), held)["of pages"]
    model.train()
    for step in range(steps):
        pages = rng.choice(full, _PAGES)
        rows = np.concatenate([order[bounds[p] : bounds[p + 1]] for p in pages])
        number = np.repeat(np.arange(len(pages)), np.diff(bounds)[pages])
        said = truth[rows].astype(np.float32)
        seen = evidence[rows] + _moved(model.spread)[number]
        loss = _loss(rng, model, seen, number, said)
        optimizer.zero_grad()
        loss.backward()
        nn.utils.clip_grad_norm_(model.parameters(), 1.0)
        optimizer.step()
        plan.step()
        if step % 100 == 99 or step == steps - 1:
            model.eval()
            figure = figures(model, held)
            model.train()
            print(step + 1, round(float(loss.detach()), 3), figure, flush=True)
            if figure["of pages"] < best:
                best, kept = figure["of pages"], _copied(model)
    model.load_state_dict(kept)
    return model.eval()


def _moved(spread: Tensor) -> Tensor:
    """(pages, F) by how much the evidence of each page is moved, at random."""
    amount = torch.full_like(spread, _MOVED)
    amount[-_OF_PAGE:] = float(np.hypot(_MOVED, _PAGE_MOVED))
    return amount * spread * torch.randn(_PAGES, len(spread))


def _copied(model: Lifts) -> dict[str, Tensor]:
    return {name: value.clone() for name, value in model.state_dict().items()}


def _loss(
    rng: np.random.Generator, model: Lifts, seen: Tensor, page: Array, truth: Array
) -> Tensor:
    page = torch.from_numpy(page)
    decided = np.zeros(len(truth), np.float32)
    share = np.where(rng.random(_PAGES) < _DECIDED, rng.uniform(0, 0.4, _PAGES), 0)
    given = (rng.random(len(truth)) < share[page]) & (truth != UNKNOWN)
    decided[given] = 2 * truth[given] - 1
    known = torch.from_numpy((truth != UNKNOWN) & ~given)
    target = torch.from_numpy(truth)[known]
    with_page, alone = model(seen, page, torch.from_numpy(decided))
    loss = nn.functional.binary_cross_entropy_with_logits
    weight = torch.from_numpy(_share(page[known].numpy()))
    return loss(with_page[known], target, weight) + 0.3 * loss(alone[known], target, weight)


def _share(page: Array) -> Array:
    """(C,) float32, 1 on the mean: a page with many corners counts more than one with few, but not
    as much more."""
    weight = np.bincount(page)[page] ** -0.5
    return np.asarray(weight / weight.mean(), np.float32)


def figures(model: Lifts, data: Corners) -> dict[str, float]:
    """How well the corners of pages are decided, all pages at once, by kinds of habit."""
    known = data.truth != UNKNOWN
    with torch.no_grad():
        evidence = torch.from_numpy(data.evidence.astype(np.float32))
        page = torch.from_numpy(data.page.astype(np.int64))
        score, alone = (s.numpy() for s in model(evidence, page, torch.zeros(len(page))))
    truth = data.truth
    habit = data.habit[data.page]
    found = {
        "loss": _nll(score[known], truth[known]),
        "of pages": _nll(score[known], truth[known], _share(data.page[known])),
        "alone": _nll(alone[known], truth[known]),
    }
    turned = data.evidence[:, 1] > np.radians(35)
    for name, own in {
        "all": known,
        "through": known & (habit == 0),
        "mixed": known & (habit > 0) & (habit < 0.85),
        "lifting": known & (habit >= 0.85),
        "lifting, corners": known & (habit >= 0.85) & turned,
        "through, corners": known & (habit == 0) & turned,
    }.items():
        right = (score > 0) == (truth > 0)
        found[name] = float(right[own].mean())
        found[f"{name}, alone"] = float(((alone > 0) == (truth > 0))[own].mean())
        found[f"{name}, on"] = float((truth > 0)[own].mean())
    return {name: round(value, 3) for name, value in found.items()}


def _nll(score: Array, truth: Array, weight: Array | float = 1.0) -> float:
    return float((weight * np.logaddexp(0, np.where(truth > 0, -score, score))).mean())


def main(argv: Sequence[str] | None = None) -> None:
    """The command line."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--data", type=Path, required=True, help="folder of SOURCE.npz drawings")
    parser.add_argument("--run", type=Path, required=True)
    parser.add_argument("--pages", type=int, default=800, help="and an eighth of that, held out")
    parser.add_argument("--jobs", type=int, default=1, help="parallel processes")
    parser.add_argument("--steps", type=int, default=3000)
    parser.add_argument("--rate", type=float, default=2e-3, help="highest learning rate")
    parser.add_argument("--start", type=Path, help="corners.npz to start from")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--dropout", type=float, default=0.3)
    parser.add_argument("--out", type=Path, default=WEIGHTS)
    args = parser.parse_args(argv)
    lineage.note_run(args.run, args, torch=torch.__version__)
    work = {"data": args.data, "seed": args.seed, "jobs": args.jobs}
    data = gathered(args.run / "train.npz", args.pages, **work)
    held = gathered(args.run / "held_out.npz", max(args.pages // 8, 1), held_out=True, **work)
    torch.manual_seed(args.seed)
    torch.set_num_threads(1)
    first = restored(args.start, args.dropout) if args.start else untrained(data, args.dropout)
    model = train(first, data, held, args.steps, args.rate, args.seed)
    found = figures(model, held)
    print(json.dumps(found, indent=1))
    (args.run / "log.json").write_text(json.dumps(found, indent=1), "utf-8")
    np.savez(args.out, **weights(model))
    digests.note(args.out, args.run)


if __name__ == "__main__":
    main()
