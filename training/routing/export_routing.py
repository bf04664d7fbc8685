"""Calibrate trained weights and write what the engine ships.

`python -m training run routing-export CHECKPOINT ... --data DIR` writes routing.onnx and
routing.json (a scale and a shift of the scores by degree, fitted on held-out drawings). Of several
checkpoints that were trained on from the same weights, the mean is taken: it keeps most of what
each of them learnt. One that is named twice counts twice.
"""

from __future__ import annotations

import argparse
import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import torch
from involute.engine import weights as shipped
from involute.engine.routing.encoding import PAIR_SIZE, TOKEN_SIZE
from involute.synthesis.composed_pages import Library

from .. import digests
from .graph_bank import Batch
from .likelihood import exact
from .restore_transformer import restored
from .set_transformer import RoutingNet
from .train_routing import run, validation

_DEGREES = 4  # 3, 4, 5, and 6 or more


def main(argv: Sequence[str] | None = None) -> None:
    """The command line."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("checkpoints", type=Path, nargs="+", help="or routing.onnx")
    parser.add_argument("--data", type=Path, required=True, help="folder of SOURCE.npz drawings")
    parser.add_argument("--traced", type=Path, help="held-out pages by training.routing.traced")
    parser.add_argument("--out", type=Path, default=shipped.FOLDER)
    parser.add_argument(
        "--joining", type=float, default=0.0, help="added to the log-odds of joining, once fitted"
    )
    args = parser.parse_args(argv)
    net = load(*args.checkpoints)
    library = Library.load(args.data, held_out=True)
    held_out = validation(library, args.traced, pages=80, seed=11)
    calibration = calibrate(net, list(held_out.values()))
    calibration["shift"] = [round(shift + args.joining, 4) for shift in calibration["shift"]]
    args.out.mkdir(parents=True, exist_ok=True)
    (args.out / "routing.json").write_text(json.dumps(calibration, indent=1) + "\n")
    export(net, args.out / "routing.onnx")
    trained = [path for path in args.checkpoints if path.suffix != ".onnx"]
    runs = [checkpoint.parent for checkpoint in dict.fromkeys(trained)]
    for name in ("routing.json", "routing.onnx"):
        digests.note(args.out / name, *runs)


def load(*checkpoints: Path) -> RoutingNet:
    """The network of a checkpoint (or the mean of several), ready to run."""
    found = [_saved(checkpoint) for checkpoint in checkpoints]
    net = RoutingNet(**found[0][0])
    weights = [state for _, state in found]
    net.load_state_dict({k: sum(w[k] for w in weights) / len(weights) for k in weights[0]})
    return net.eval()


def _saved(path: Path) -> tuple[dict[str, Any], dict[str, torch.Tensor]]:
    """Sizes and weights of checkpoint.pt or of routing.onnx."""
    if path.suffix == ".onnx":
        net = restored(path)
        return net.config, net.state_dict()
    saved = torch.load(path, map_location="cpu")
    return saved["config"], saved["mean"]


@torch.no_grad()
def _scores(net: RoutingNet, batches: list[Batch]) -> list[torch.Tensor]:
    return [run(net, batch, "cpu") for batch in batches]


def calibrate(net: RoutingNet, batches: list[Batch]) -> dict[str, list[float]]:
    """Scale and shift of the scores by degree that make the truth of held-out pages most likely.

    The scale is a temperature; the shift is the balance between joining and ending, which is what
    keeps the number of strokes right.
    """
    raw = _scores(net, batches)
    fits = []
    for degree in range(3, 3 + _DEGREES):
        parts = []
        for scores, batch in zip(raw, batches, strict=True):
            count = np.minimum(batch.mask.sum(1), 2 + _DEGREES)
            clear = (batch.truth.sum(2) <= 1).all(1) & (batch.asked > 0)
            rows = np.flatnonzero((count == degree) & clear)
            mask, truth = (torch.from_numpy(a[rows]) for a in (batch.mask, batch.truth))
            parts.append((scores[rows], mask, truth))
        fits.append(_fit(parts))
    scale, shift = zip(*fits, strict=True)
    return {"scale": list(scale), "shift": list(shift)}


def _fit(parts: list[tuple[torch.Tensor, torch.Tensor, torch.Tensor]]) -> tuple[float, float]:
    """Scale and shift under which (scores, mask, truth) of junctions are most likely."""
    scale = torch.ones(1, requires_grad=True)
    shift = torch.zeros(1, requires_grad=True)
    optimizer = torch.optim.LBFGS([scale, shift], max_iter=60, line_search_fn="strong_wolfe")
    count = sum(len(scores) for scores, _, _ in parts)
    if not count:
        return 1.0, 0.0

    def loss() -> torch.Tensor:
        optimizer.zero_grad()
        total = sum(exact(s * scale + shift, m, t).sum() for s, m, t in parts) / count
        total.backward()
        return total

    optimizer.step(loss)
    return round(float(scale.detach()), 4), round(float(shift.detach()), 4)


def export(net: RoutingNet, path: Path) -> None:
    """Write the network as ONNX; any number of junctions, any number of slots."""
    j, d = 7, 5
    example = (
        torch.randn(j, d, TOKEN_SIZE),
        torch.randn(j, d, d, PAIR_SIZE),
        torch.arange(j * d),
        torch.ones(j, d),
    )
    axes = {
        "tokens": {0: "junctions", 1: "slots"},
        "pairs": {0: "junctions", 1: "slots", 2: "slots"},
        "sibling": {0: "tokens"},
        "mask": {0: "junctions", 1: "slots"},
        "scores": {0: "junctions", 1: "slots", 2: "slots"},
    }
    torch.onnx.export(
        net,
        example,
        str(path),
        input_names=["tokens", "pairs", "sibling", "mask"],
        output_names=["scores"],
        dynamic_axes=axes,
        opset_version=17,
        dynamo=False,
    )


if __name__ == "__main__":
    main()
