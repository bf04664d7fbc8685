"""Short trainings that differ in the loss of the centerline alone, and their figures as a table.

python -m involute.training.centerline.compare_losses --data DIR --run DIR --steps 500

Every training sees the same pages in the same order. The level that counts as a line is chosen for
each loss by itself: they need not agree on what a probability is.
"""

from __future__ import annotations

import argparse
from pathlib import Path

import numpy as np
import torch

from ...synthesis.line_art import Array
from . import train_centerline
from .losses import CENTERLINE_LOSSES
from .page_batches import validation_pages
from .page_figures import page_figures, pooled
from .restore_unet import restored

LEVELS = (0.15, 0.25, 0.35, 0.45, 0.55)


def main(arguments: list[str] | None = None) -> None:
    """The command line; further options go to `train`."""
    parser = argparse.ArgumentParser(prog="compare_losses", description=__doc__.splitlines()[0])
    parser.add_argument("--data", type=Path, required=True)
    parser.add_argument("--run", type=Path, required=True)
    parser.add_argument("--steps", type=int, default=500)
    options, others = parser.parse_known_args(arguments)
    check = validation_pages(options.data, 24)
    rows = {}
    for loss in CENTERLINE_LOSSES:
        run = options.run / loss
        if not (run / "done").exists():
            common = ["--data", str(options.data), "--steps", str(options.steps)]
            train_centerline.main(
                [*common, "--minutes", "1e9", "--run", str(run), "--loss", loss, *others]
            )
            (run / "done").touch()
        rows[loss] = judge(run / "checkpoint.pt", check)
    columns = list(next(iter(rows.values())))
    print("| loss | " + " | ".join(columns) + " |\n" + "|---" * (len(columns) + 1) + "|")
    for loss, row in rows.items():
        print(f"| {loss} | " + " | ".join(f"{row[c]:.3f}" for c in columns) + " |")


@torch.no_grad()
def judge(checkpoint: Path, check: Array) -> dict[str, float]:
    """Ridge figures at the level with the best balance of precision and recall."""
    net = restored(checkpoint)
    seen = [net(torch.from_numpy(p[None, :1]).float() / 255).sigmoid()[0].numpy() for p in check]
    truth = check[:, 1:].astype(np.float32) / 255
    best: dict[str, float] = {"F1": -1.0}
    for level in LEVELS:
        pairs = zip(seen, truth, strict=True)
        figures = pooled([page_figures(s, t, level) for s, t in pairs])
        p, r = figures["precision"], figures["recall"]
        f1 = 2 * p * r / max(p + r, 1e-9)
        if f1 > best["F1"]:
            best = {"F1": f1, "level": level, "precision": p, "recall": r}
            best["chamfer px"] = figures["chamfer_px"]
    return best


if __name__ == "__main__":
    main()
