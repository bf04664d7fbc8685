"""Train the routing network: `python -m training.routing.train_routing --data DIR --out DIR`.

Resumable: a run that finds its own checkpoint in --out goes on where it stopped. Every
evaluation is a line of JSON in --out/log.jsonl.
"""

from __future__ import annotations

import argparse
import json
import math
import time
from copy import deepcopy
from pathlib import Path

import numpy as np
import torch

from ...synthesis.composed_pages import Library
from . import likelihood
from .augment import augmented
from .graph_bank import Batch, Batches, encoded, joined, true_page
from .judge import Verdict, judge
from .restore_transformer import restored
from .set_transformer import RoutingNet
from .traced import load
from .widen import widened


def main() -> None:
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
    parser.add_argument("--every", type=int, default=500, help="steps between evaluations")
    parser.add_argument("--pages", type=int, default=40, help="pages of an evaluation")
    parser.add_argument("--minutes", type=float, default=1e9, help="stop after so long")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--device", default="cpu", help="cpu, cuda or mps")
    parser.add_argument("--traced", type=Path, nargs="*", default=[], help="pages by `traced`")
    parser.add_argument("--traced-held-out", type=Path, help="the same, to validate on")
    parser.add_argument("--traced-share", type=float, default=0.4)
    parser.add_argument("--start", type=Path, help="checkpoint.pt or routing.onnx to start from")
    train(parser.parse_args())


def train(args: argparse.Namespace) -> None:
    """Run the training that the arguments describe."""
    args.out.mkdir(parents=True, exist_ok=True)
    torch.manual_seed(args.seed)
    net = _first(args).to(args.device)
    mean = deepcopy(net).eval()
    optimizer = torch.optim.AdamW(net.parameters(), lr=args.rate, weight_decay=0.01)
    checkpoint, first, before = args.out / "checkpoint.pt", 0, 0.0
    if checkpoint.exists():
        saved = torch.load(checkpoint, map_location=args.device)
        net.load_state_dict(saved["net"])
        mean.load_state_dict(saved["mean"])
        optimizer.load_state_dict(saved["optimizer"])
        first, before = saved["step"], saved["minutes"]
    traced = tuple(args.traced)
    seed = args.seed * 1_000_000 + first
    stream = Batches(args.data, traced, args.traced_share, args.junctions, seed)
    batches = iter(stream.loader(args.workers))
    held_out = validation(Library.load(args.data, True), args.traced_held_out, args.pages)
    loss_of = getattr(likelihood, args.loss)
    started, running, step, done = time.monotonic(), [], first, 0.0
    while done < 1:
        minutes = before + (time.monotonic() - started) / 60
        done = max((step + 1) / args.steps, minutes / args.minutes)
        for group in optimizer.param_groups:
            group["lr"] = args.rate * learning_rate(step, done)
        batch = next(batches)
        scores = run(net, batch, args.device)
        mask, truth, asked = (
            torch.from_numpy(a).to(args.device) for a in (batch.mask, batch.truth, batch.asked)
        )
        loss = (loss_of(scores, mask, truth) * asked).sum() / asked.sum().clamp(min=1)
        optimizer.zero_grad()
        loss.backward()
        torch.nn.utils.clip_grad_norm_(net.parameters(), 1.0)
        optimizer.step()
        step += 1
        # The mean of the last few hundred steps is better than any one of them.
        keep = min(0.995, step / (step + 10))
        with torch.no_grad():
            for slow, fast in zip(mean.parameters(), net.parameters(), strict=True):
                slow.lerp_(fast, 1 - keep)
        running.append(float(loss.detach()))
        if done >= 1 or step % args.every == 0:
            record = {"step": step, "minutes": round(minutes, 2), "loss": float(np.mean(running))}
            for name, part in held_out.items():
                record[name] = evaluate(mean, part, args.device).summary()
            running = []
            with (args.out / "log.jsonl").open("a") as log:
                log.write(json.dumps(record) + "\n")
            state = {"net": net.state_dict(), "mean": mean.state_dict(), "config": net.config}
            state |= {"optimizer": optimizer.state_dict(), "step": step, "minutes": minutes}
            torch.save(state, checkpoint)


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


def learning_rate(step: int, done: float) -> float:
    """Share of the full rate: a short warm-up, then a cosine over the whole training."""
    return min(1.0, (step + 1) / 200) * (0.02 + 0.49 * (1 + math.cos(math.pi * min(done, 1.0))))


def run(net: RoutingNet, batch: Batch, device: str) -> torch.Tensor:
    """(J, D, D) scores of a batch."""
    arrays = (batch.tokens, batch.pairs, batch.sibling.astype(np.int64), batch.mask, batch.page)
    return net(*(torch.from_numpy(a).to(device) for a in arrays))


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
    drawn, rough = [], []
    while len(drawn) < pages:
        page = true_page(library.page(rng))
        if len(page.graph.junctions):
            drawn.append(encoded(page, {}, 8))
            rough.append(encoded(augmented(rng, page), {}, 8))
    parts = {"true": drawn, "rough": rough}
    if traced:
        parts["traced"] = [encoded(page, {}, 8) for page in load(traced)[:pages]]
    return {name: joined([b for b in batches if len(b.mask)]) for name, batches in parts.items()}


if __name__ == "__main__":
    main()
