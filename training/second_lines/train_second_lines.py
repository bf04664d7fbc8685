"""Learn on which runs of a stroke a second one goes on, for `engine/routing/second_lines.py`.

`python -m training run second-lines --data DIR --run RUN --pages 400` draws and traces pages on
which lines run together (`run_pages`; RUN/train.npz and RUN/held_out.npz, started again it goes
on), trains a small network in a minute and writes engine/weights/second_lines.npz. The figures are
in RUN/log.jsonl.
"""

from __future__ import annotations

import argparse
import json
from collections.abc import Iterator, Sequence
from pathlib import Path

import numpy as np
import torch
from involute.engine.routing.second_lines import WEIGHTS
from torch import Tensor, nn

from .. import digests, lineage
from ..loop import Schedule, Training
from .run_pages import gathered

Array = np.ndarray
_WIDTHS = (48, 24)  # of the hidden layers
_NOISE = 0.5  # spreads, on every number, so that it does not learn single runs by heart
_LIMITS = (0.3, 0.5, 0.7, 0.8, 0.9)


def main(argv: Sequence[str] | None = None) -> None:
    """The command line."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--data", type=Path, required=True, help="folder of SOURCE.npz drawings")
    parser.add_argument("--run", type=Path, required=True)
    parser.add_argument("--pages", type=int, default=400, help="and a fourth of that, held out")
    parser.add_argument("--jobs", type=int, default=1, help="parallel processes")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--steps", type=int, default=1500)
    parser.add_argument("--out", type=Path, default=WEIGHTS)
    args = parser.parse_args(argv)
    lineage.note_run(args.run, args, torch=torch.__version__)
    parts = []
    for name, pages in (("train", args.pages), ("held_out", args.pages // 4)):
        work = args.data, name == "held_out", args.seed
        parts.append(gathered(args.run / f"{name}.npz", pages, args.jobs, work))
    net, figures = train(*parts, args.steps, args.seed, args.run)
    print(json.dumps(figures, indent=1))
    np.savez(args.out, **net)
    digests.note(args.out, args.run)


def train(
    data: tuple[Array, Array], held: tuple[Array, Array], steps: int, seed: int, folder: Path
) -> tuple[dict[str, Array], dict[str, object]]:
    """Weights as `engine/routing/second_lines.py` reads them, and figures on held-out runs."""
    torch.manual_seed(seed)
    rows, labels = data
    mean, spread = rows.mean(0), rows.std(0) + 1e-3
    layers: list[nn.Module] = []
    for a, b in zip((rows.shape[1], *_WIDTHS), (*_WIDTHS, 3), strict=True):
        layers += [nn.Linear(a, b), nn.ReLU(), nn.Dropout(0.3)]
    net = nn.Sequential(*layers[:-2])
    schedule = Schedule(steps, rate=2e-3, least=0.0, every=max(steps // 10, 1))
    training = Training(folder, net, schedule, weight_decay=0.1)
    seen = torch.from_numpy(_scaled(held[0], mean, spread))

    def judge(net: nn.Module) -> dict[str, object]:
        return {"runs": len(labels), "two": int((labels > 0).sum())} | _figures(net, seen, held[1])

    x, y = torch.from_numpy(_scaled(rows, mean, spread)), torch.from_numpy(labels.astype(np.int64))
    training.run(_batches(x, y), _loss, judge)
    weights = {"mean": mean, "spread": spread}
    for number, layer in enumerate(m for m in training.mean if isinstance(m, nn.Linear)):
        weights[f"weight{number}"] = layer.weight.detach().numpy().T.copy()
        weights[f"bias{number}"] = layer.bias.detach().numpy()
    return {k: np.asarray(v, np.float32) for k, v in weights.items()}, judge(training.mean)


def _scaled(rows: Array, mean: Array, spread: Array) -> Array:
    return np.clip((rows - mean) / spread, -5, 5).astype(np.float32)


def _batches(x: Tensor, y: Tensor) -> Iterator[tuple[Tensor, Tensor]]:
    while True:
        pick = torch.randint(len(x), (256,))
        yield x[pick] + _NOISE * torch.randn(len(pick), x.shape[1]), y[pick]


def _loss(net: nn.Module, batch: tuple[Tensor, Tensor]) -> dict[str, Tensor]:
    seen, truth = batch
    return {"total": nn.functional.cross_entropy(net(seen), truth)}


@torch.no_grad()
def _figures(net: nn.Module, held: Tensor, truth: Array) -> dict[str, object]:
    """How well held-out runs are judged; what each limit would double, how much of it rightly."""
    log = torch.log_softmax(net(held), 1).numpy()
    two, crosses = 1 - np.exp(log[:, 0]), log[:, 2] > log[:, 1]
    right = (truth > 0) & (crosses == (truth == 2))
    figures: dict[str, object] = {
        "held-out runs": len(truth),
        "held-out two": int((truth > 0).sum()),
        "loss": round(float(-log[np.arange(len(truth)), truth].mean()), 3),
        "crossing told": round(float(right[truth > 0].mean()), 3),
    }
    for limit in _LIMITS:
        made = two > limit
        figures[f"above {limit}"] = {
            "found": round(float((made & right).sum() / max(1, (truth > 0).sum())), 3),
            "right": round(float((made & right).sum() / max(1, made.sum())), 3),
        }
    return figures


if __name__ == "__main__":
    main()
