"""Train the centerline network; stop and resume at any time.

    python -m training run centerline --data DIR --run RUN --minutes 120

RUN is the folder of the run, see `training/loop.py`; its log has a line per validation: losses,
share of ridge found, share of it that is true, junctions found.
"""

from __future__ import annotations

import argparse
import math
from pathlib import Path

import numpy as np
import torch
from torch import Tensor

from .. import lineage
from ..loop import Schedule, Training
from .losses import CENTERLINE_LOSSES, total_loss
from .page_batches import PAGE, STREAMS, Pages, degrade, loader, split, validation_pages
from .page_figures import page_figures, pooled
from .restore_unet import restored, with_all_heads
from .shared_pages import SharedPages
from .unet import WIDTHS, CenterlineNet


def main(arguments: list[str] | None = None) -> None:
    """The command line."""
    parser = argparse.ArgumentParser(prog="train", description=__doc__.splitlines()[0])
    add = parser.add_argument
    add("--data", type=Path, required=True, help="folder with the true drawings (.npz)")
    add("--run", type=Path, required=True, help="folder of this run; resumed when it exists")
    add("--pages", default="clean", choices=list(STREAMS), help="what is drawn on them")
    add("--minutes", type=float, default=120.0, help="length of the whole schedule")
    add("--steps", type=int, default=10**9, help="or its number of steps, whichever ends first")
    add("--stop-after", type=float, default=math.inf, help="leave after so many minutes, to resume")
    add("--device", default="cpu", choices=["cpu", "cuda", "mps"])
    add("--seed", type=int, default=1)
    add("--batch", type=int, default=12)
    add("--crop", type=int, default=192)
    add("--side", type=int, default=PAGE, help="of a page that crops are cut from, px")
    add("--fresh", type=float, default=1.0, help="new pages per batch and worker")
    add("--workers", type=int, default=1)
    add("--threads", type=int, default=1, help="of torch, on the CPU")
    add("--shared", type=Path, help="folder of pages that `shared_pages` draws meanwhile")
    add("--rate", type=float, default=2e-3, help="highest learning rate")
    add("--loss", default="bce_dice", choices=list(CENTERLINE_LOSSES))
    add("--widths", type=int, nargs="+", default=list(WIDTHS))
    add("--counts", type=int, nargs="+", help="convolutions of each level on the way down")
    add("--compile", action="store_true", help="by torch.compile: 12 %% less a step on an H200")
    add("--start-from", type=Path, help="checkpoint or ONNX file that a new run begins with")
    add("--every", type=int, default=500, help="steps between validations")
    train(parser.parse_args(arguments))


def train(options: argparse.Namespace) -> None:
    """Run the schedule, or the piece of it that --stop-after allows."""
    torch.set_num_threads(options.threads)
    torch.manual_seed(options.seed)
    device = torch.device(options.device)
    if options.start_from:
        net = with_all_heads(restored(options.start_from)).train()
    else:
        net = CenterlineNet(tuple(options.widths), options.counts and tuple(options.counts))
    net = net.to(device, memory_format=torch.channels_last)
    weights = sum(p.numel() for p in net.parameters())
    lineage.note_run(options.run, options, torch=torch.__version__, weights=weights)
    schedule = Schedule(
        options.steps, options.minutes, options.stop_after, options.rate, every=options.every
    )
    training = Training(options.run, net, schedule)
    check = validation_pages(options.data, 24, stream=options.pages)
    seed = options.seed + 7919 * training.step
    crops = options.batch, options.crop
    if options.shared:
        pages: Pages = SharedPages(options.shared, *crops, options.side, seed)
    else:
        pages = Pages(options.data, *crops, options.fresh, seed, options.side, stream=options.pages)
    noise = torch.Generator(device).manual_seed(options.seed + training.step)

    def losses(ink: Tensor, truth: Tensor) -> dict[str, Tensor]:
        with torch.autocast(device.type, torch.bfloat16, enabled=device.type != "mps"):
            raw = net(ink)
        return total_loss(raw.float(), truth, options.loss)

    fast = torch.compile(losses) if options.compile else losses

    def loss(_: CenterlineNet, batch: Tensor) -> dict[str, Tensor]:
        ink, truth = split(batch.to(device, non_blocking=True))
        return fast(degrade(ink, noise), truth)

    batches = loader(pages, options.workers, pinned=device.type == "cuda")
    training.run(batches, loss, lambda mean: validate(mean, check, device))


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


if __name__ == "__main__":
    main()
