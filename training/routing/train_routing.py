"""Train the routing network: `python -m training run routing --data DIR --out RUN`.

RUN is the folder of the run, see `training/loop.py`; a run that exists goes on where it stopped.
"""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from pathlib import Path

import numpy as np
import torch
from involute.synthesis.composed_pages import Library

from .. import lineage
from ..loop import Schedule, Training
from . import likelihood
from .augment import augmented
from .graph_bank import Batch, Batches, encoded, joined, true_page
from .judge import Verdict, judge
from .page_file import load
from .restore_transformer import restored
from .set_transformer import RoutingNet
from .supply import Supply, on_device
from .widen import widened

_WINDOWS = 3  # traced pages for each of the others: they are windows, with a third of the junctions


def main(argv: Sequence[str] | None = None) -> None:
    """The command line."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--data", type=Path, required=True, help="folder of SOURCE.npz drawings")
    parser.add_argument("--out", type=Path, required=True)
    parser.add_argument("--steps", type=int, default=12000)
    parser.add_argument("--junctions", type=int, default=600, help="junctions a step")
    parser.add_argument("--rate", type=float, default=2e-3)
    parser.add_argument("--loss", choices=("exact", "sinkhorn"), default="exact")
    parser.add_argument("--width", type=int, default=64, help="may be twice that of --start")
    parser.add_argument("--dropout", type=float, default=0.0)
    parser.add_argument("--workers", type=int, default=0, help="processes that make the batches")
    parser.add_argument("--together", type=int, default=1, help="batches that make a step's")
    parser.add_argument("--kept", type=int, default=0, help="batches kept to be taken again")
    parser.add_argument("--every", type=int, default=500, help="steps between evaluations")
    parser.add_argument("--pages", type=int, default=40, help="pages of an evaluation")
    parser.add_argument("--minutes", type=float, default=1e9, help="stop after so long")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--device", default="cpu", help="cpu, cuda or mps")
    parser.add_argument("--traced", type=Path, nargs="*", default=[], help="pages by `traced`")
    parser.add_argument("--traced-held-out", type=Path, help="the same, to validate on")
    parser.add_argument("--traced-share", type=float, default=0.4)
    parser.add_argument("--start", type=Path, help="checkpoint.pt or routing.onnx to start from")
    train(parser.parse_args(argv))


def train(args: argparse.Namespace) -> None:
    """Run the training that the arguments describe."""
    torch.manual_seed(args.seed)
    net = _first(args).to(args.device)
    weights = sum(p.numel() for p in net.parameters())
    lineage.note_run(args.out, args, torch=torch.__version__, weights=weights)
    schedule = Schedule(
        args.steps, args.minutes, rate=args.rate, least=0.02, every=args.every, memory=200
    )
    training = Training(args.out, net, schedule, config=net.config)
    seed = args.seed * 1_000_000 + training.step
    stream = Batches(args.data, tuple(args.traced), args.traced_share, args.junctions, seed)
    held_out = validation(Library.load(args.data, True), args.traced_held_out, args.pages)
    loss_of = getattr(likelihood, args.loss)

    def loss(net: RoutingNet, batch: Batch) -> dict[str, torch.Tensor]:
        batch = on_device(batch, args.device)
        lost = loss_of(run(net, batch, args.device), batch.mask, batch.truth) * batch.asked
        return {"total": lost.sum() / batch.asked.sum().clamp(min=1)}

    def judged(mean: RoutingNet) -> dict[str, dict[str, float]]:
        return {
            name: evaluate(mean, part, args.device).summary() for name, part in held_out.items()
        }

    loader = stream.loader(args.workers)
    training.run(Supply(loader, args.device, args.together, args.kept, seed), loss, judged)


def _first(args: argparse.Namespace) -> RoutingNet:
    """The network to start with: new, or that of --start, made wider where it is half as wide."""
    wanted = RoutingNet(args.width, args.width // 2, dropout=args.dropout)
    if not args.start:
        return wanted
    if args.start.suffix == ".onnx":
        given = restored(args.start)
    else:
        saved = torch.load(args.start, map_location="cpu")
        given = RoutingNet(**saved["config"])
        given.load_state_dict(saved["mean"])
    if 2 * given.config["width"] == args.width:
        given = widened(given)
    wanted.load_state_dict(given.state_dict())
    return wanted


def run(net: RoutingNet, batch: Batch, device: str) -> torch.Tensor:
    """(J, D, D) scores of a batch."""
    given = on_device(batch, device)
    features = given.tokens.float(), given.pairs.float()
    return net(*features, given.sibling.long(), given.mask, given.page)


@torch.no_grad()
def evaluate(net: RoutingNet, batch: Batch, device: str = "cpu") -> Verdict:
    """How the network decides the junctions of a batch; contradicting ones are left out."""
    clear = (batch.truth.sum(2) <= 1).all(1) & (batch.asked > 0)
    scores = run(net, batch, device).cpu().numpy()
    return judge(scores[clear], batch.mask[clear], batch.truth[clear])


def validation(
    library: Library, traced: Path | None = None, pages: int = 40, seed: int = 5
) -> dict[str, Batch]:
    """Held-out pages: as drawn ("true"), varied at random ("rough"), and really traced."""
    rng = np.random.default_rng(seed)
    drawn: list[Batch] = []
    rough: list[Batch] = []
    while len(drawn) < pages:
        page = true_page(library.page(rng))
        if len(page.graph.junctions):
            drawn.append(encoded(page, {}, 8))
            rough.append(encoded(augmented(rng, page), {}, 8))
    parts = {"true": drawn, "rough": rough}
    if traced:
        parts["traced"] = [encoded(page, {}, 8) for page in load(traced)[: _WINDOWS * pages]]
    return {name: joined([b for b in batches if len(b.mask)]) for name, batches in parts.items()}


if __name__ == "__main__":
    main()
