"""Train the centerline network; stop and resume at any time.

    python -m involute.training.centerline.train_centerline --data DIR --run RUN --minutes 120

RUN receives config.json, checkpoint.pt (resumed from when it exists) and log.jsonl, one line per
validation: losses, share of ridge found, share of it that is true, junctions found.
"""

from __future__ import annotations

import argparse
import copy
import hashlib
import json
import math
import time
from pathlib import Path

import numpy as np
import torch
from torch import Tensor

from .losses import CENTERLINE_LOSSES, total_loss
from .page_batches import Pages, degrade, loader, split, validation_pages
from .page_figures import page_figures, pooled
from .restore_unet import restored
from .unet import WIDTHS, CenterlineNet


def main(arguments: list[str] | None = None) -> None:
    """The command line."""
    parser = argparse.ArgumentParser(prog="train", description=__doc__.splitlines()[0])
    add = parser.add_argument
    add("--data", type=Path, required=True, help="folder with the true drawings (.npz)")
    add("--run", type=Path, required=True, help="folder of this run; resumed when it exists")
    add("--minutes", type=float, default=120.0, help="length of the whole schedule")
    add("--steps", type=int, default=10**9, help="or its number of steps, whichever ends first")
    add("--stop-after", type=float, default=math.inf, help="leave after so many minutes, to resume")
    add("--device", default="cpu", choices=["cpu", "cuda", "mps"])
    add("--seed", type=int, default=1)
    add("--batch", type=int, default=12)
    add("--crop", type=int, default=192)
    add("--fresh", type=float, default=1.0, help="new pages per batch and worker")
    add("--workers", type=int, default=1)
    add("--threads", type=int, default=1, help="of torch, on the CPU")
    add("--rate", type=float, default=2e-3, help="highest learning rate")
    add("--loss", default="bce_dice", choices=list(CENTERLINE_LOSSES))
    add("--widths", type=int, nargs="+", default=list(WIDTHS))
    add("--start-from", type=Path, help="checkpoint or ONNX file that a new run begins with")
    add("--every", type=int, default=500, help="steps between validations")
    train(parser.parse_args(arguments))


class Run:
    """What a checkpoint holds: network, its running mean, optimiser, clock."""

    def __init__(self, options: argparse.Namespace) -> None:
        self.folder = options.run
        self.device = torch.device(options.device)
        torch.manual_seed(options.seed)
        if options.start_from:
            self.net = restored(options.start_from).train()
        else:
            self.net = CenterlineNet(tuple(options.widths))
        self.net = self.net.to(self.device, memory_format=torch.channels_last)
        self.mean = copy.deepcopy(self.net).eval().requires_grad_(False)
        self.optimiser = torch.optim.AdamW(self.net.parameters(), options.rate, weight_decay=1e-2)
        self.step, self.seconds = 0, 0.0
        if (self.folder / "checkpoint.pt").exists():
            self._load(self.folder / "checkpoint.pt")

    def _load(self, path: Path) -> None:
        state = torch.load(path, map_location=self.device)
        self.net.load_state_dict(state["net"])
        self.mean.load_state_dict(state["mean"])
        self.optimiser.load_state_dict(state["optimiser"])
        self.step, self.seconds = state["step"], state["seconds"]

    def save(self) -> None:
        """Write the checkpoint; a stop while writing leaves the old one."""
        state = {
            "net": self.net.state_dict(),
            "mean": self.mean.state_dict(),
            "optimiser": self.optimiser.state_dict(),
            "step": self.step,
            "seconds": self.seconds,
        }
        torch.save(state, self.folder / "checkpoint.new")
        (self.folder / "checkpoint.new").replace(self.folder / "checkpoint.pt")

    @torch.no_grad()
    def follow(self) -> None:
        """Move the running mean; its memory grows with the number of steps up to 1000."""
        keep = min(0.999, (1 + self.step) / (10 + self.step))
        for slow, fast in zip(
            self.mean.state_dict().values(), self.net.state_dict().values(), strict=True
        ):
            if slow.dtype.is_floating_point:
                slow.lerp_(fast, 1 - keep)
            else:
                slow.copy_(fast)


def learning_rate(progress: float, step: int, highest: float) -> float:
    """Warm-up over 200 steps, then a cosine down to a hundredth."""
    cosine = 0.5 * (1 + math.cos(math.pi * min(1.0, progress)))
    return highest * min(1.0, (step + 1) / 200) * (0.01 + 0.99 * cosine)


def train(options: argparse.Namespace) -> None:
    """Run the schedule, or the piece of it that --stop-after allows."""
    torch.set_num_threads(options.threads)
    options.run.mkdir(parents=True, exist_ok=True)
    run = Run(options)
    record = {k: str(v) if isinstance(v, Path) else v for k, v in vars(options).items()}
    record |= {"data_sha256": data_hash(options.data), "torch": torch.__version__}
    record |= {"weights": sum(p.numel() for p in run.net.parameters())}
    (options.run / "config.json").write_text(json.dumps(record, indent=1, default=str))
    check = validation_pages(options.data, 24)
    pages = Pages(
        options.data, options.batch, options.crop, options.fresh, options.seed + 7919 * run.step
    )
    generator = torch.Generator(run.device).manual_seed(options.seed + run.step)
    begin = last = time.monotonic()
    parts: dict[str, float] = {}
    for batch in loader(pages, options.workers):
        now = time.monotonic()
        run.seconds += now - last
        last = now
        progress = max((run.step + 1) / options.steps, run.seconds / (60 * options.minutes))
        losses = _step(run, batch, generator, progress, options)
        for name, value in losses.items():
            parts[name] = 0.98 * parts.get(name, float(value)) + 0.02 * float(value)
        done = progress >= 1
        if run.step % options.every == 0 or done:
            figures = {"step": run.step, "minutes": round(run.seconds / 60, 2)}
            figures |= {f"train_{k}": round(v, 5) for k, v in parts.items()}
            figures |= validate(run.mean, check, run.device)
            with open(options.run / "log.jsonl", "a") as log:
                log.write(json.dumps(figures) + "\n")
        if run.step % 200 == 0 or done:
            run.save()
        if done or now - begin > 60 * options.stop_after:
            break
    run.save()


def _step(
    run: Run,
    batch: Tensor,
    generator: torch.Generator,
    progress: float,
    options: argparse.Namespace,
) -> dict[str, Tensor]:
    for group in run.optimiser.param_groups:
        group["lr"] = learning_rate(progress, run.step, options.rate)
    ink, truth = split(batch.to(run.device, non_blocking=True))
    ink = degrade(ink, generator)
    with torch.autocast(run.device.type, torch.bfloat16, enabled=run.device.type != "mps"):
        raw = run.net(ink)
    losses = total_loss(raw.float(), truth, options.loss)
    run.optimiser.zero_grad(set_to_none=True)
    losses["total"].backward()
    torch.nn.utils.clip_grad_norm_(run.net.parameters(), 1.0)
    run.optimiser.step()
    run.step += 1
    run.follow()
    return {name: value.detach() for name, value in losses.items()}


@torch.no_grad()
def validate(net: CenterlineNet, check: np.ndarray, device: torch.device) -> dict[str, float]:
    """Losses and figures of `metrics` on pages of the held-out drawings."""
    totals, figures = [], []
    for page in check:
        ink, truth = split(torch.from_numpy(page[None]).to(device))
        raw = net(ink)
        totals.append(float(total_loss(raw, truth)["total"]))
        figures.append(page_figures(raw.sigmoid()[0].cpu().numpy(), truth[0].cpu().numpy()))
    return {"loss": round(float(np.mean(totals)), 5)} | pooled(figures)


def data_hash(folder: Path) -> str:
    """A short digest of the drawings a run was trained on."""
    digest = hashlib.sha256()
    for path in sorted(folder.glob("*.npz")):
        digest.update(path.name.encode())
        digest.update(path.read_bytes())
    return digest.hexdigest()[:16]


if __name__ == "__main__":
    main()
