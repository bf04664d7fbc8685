"""The one loop that every network is trained by: stopped and resumed at any time.

A run is a folder: config.json (what it was asked and what it learns from, see `lineage`),
checkpoint.pt (written beside and moved into place, so that a stop leaves the last whole one) and
log.jsonl, one line per evaluation.
"""

from __future__ import annotations

import json
import math
import time
from collections.abc import Callable, Iterable, Iterator
from copy import deepcopy
from dataclasses import dataclass
from pathlib import Path
from typing import Any, TypeVar

import torch
from torch import Tensor, nn

CHECKPOINT, LOG = "checkpoint.pt", "log.jsonl"
Batch = TypeVar("Batch")
# (network, batch) -> losses by name; "total" is what is made small.
Loss = Callable[[nn.Module, Batch], dict[str, Tensor]]
# mean network -> figures of an evaluation.
Judge = Callable[[nn.Module], dict[str, Any]]


@dataclass(frozen=True)
class Schedule:
    """How long, how fast, and how often something is written.

    steps, minutes: of the whole training, whichever ends first. stop_after: minutes after which
    this run leaves, to be resumed. rate: highest learning rate; least: the last one's share of
    it. every, save: steps between evaluations and between checkpoints. memory: steps that the
    running mean looks back at most.
    """

    steps: int = 10**9
    minutes: float = math.inf
    stop_after: float = math.inf
    rate: float = 2e-3
    least: float = 0.01
    every: int = 500
    save: int = 200
    memory: int = 1000

    def progress(self, step: int, seconds: float) -> float:
        """Share of the training that is done after a step."""
        return max(step / self.steps, seconds / (60 * self.minutes))

    def learning_rate(self, step: int, progress: float) -> float:
        """Warm-up over 200 steps, then a cosine down to the least."""
        cosine = 0.5 * (1 + math.cos(math.pi * min(1.0, progress)))
        return self.rate * min(1.0, (step + 1) / 200) * (self.least + (1 - self.least) * cosine)


class Training:
    """A network in training: its running mean, optimizer, step and clock, kept in a folder.

    The mean of the last few hundred steps is better than any one of them: it is what is judged and
    exported.
    """

    def __init__(
        self,
        folder: Path,
        net: nn.Module,
        schedule: Schedule,
        *,
        weight_decay: float = 1e-2,
        config: dict[str, Any] | None = None,
    ) -> None:
        self.folder, self.net, self.schedule = folder, net, schedule
        self.config = config or {}
        self.mean = deepcopy(net).eval().requires_grad_(False)
        self.optimizer = torch.optim.AdamW(
            net.parameters(), schedule.rate, weight_decay=weight_decay
        )
        self.device = next(net.parameters()).device
        self.step, self.seconds = 0, 0.0
        folder.mkdir(parents=True, exist_ok=True)
        if (folder / CHECKPOINT).exists():
            self._resume()

    def run(self, batches: Iterable[Batch], loss: Loss[Batch], judge: Judge) -> None:
        """Train on batches to the end of the schedule, or as far as stop_after allows."""
        if self.schedule.progress(self.step, self.seconds) >= 1:
            return
        begin, parts = time.monotonic(), _Running()
        for batch, done in self._clocked(batches):
            losses = self._learn(batch, loss, done)
            parts.add(losses)
            if self.step % self.schedule.every == 0 or done >= 1:
                figures = {"step": self.step, "minutes": round(self.seconds / 60, 2)}
                self._log(figures | parts.means() | judge(self.mean))
            if self.step % self.schedule.save == 0:
                self.save()
            if done >= 1 or time.monotonic() - begin > 60 * self.schedule.stop_after:
                break
        self.save()

    def save(self) -> None:
        """Write the checkpoint; a stop while writing leaves the old one."""
        state = {
            "net": self.net.state_dict(),
            "mean": self.mean.state_dict(),
            "optimizer": self.optimizer.state_dict(),
            "config": self.config,
            "step": self.step,
            "seconds": self.seconds,
        }
        part = self.folder / "checkpoint.new"
        torch.save(state, part)
        part.replace(self.folder / CHECKPOINT)

    def _resume(self) -> None:
        state = torch.load(self.folder / CHECKPOINT, map_location=self.device)
        self.net.load_state_dict(state["net"])
        self.mean.load_state_dict(state["mean"])
        # "optimiser" and "minutes" are names of older runs.
        self.optimizer.load_state_dict(state.get("optimizer") or state["optimiser"])
        self.step = state["step"]
        self.seconds = state["seconds"] if "seconds" in state else 60 * state["minutes"]

    def _clocked(self, batches: Iterable[Batch]) -> Iterator[tuple[Batch, float]]:
        """Batches, each with the share of the training that is done after it."""
        last = time.monotonic()
        for batch in batches:
            now = time.monotonic()
            self.seconds, last = self.seconds + now - last, now
            yield batch, self.schedule.progress(self.step + 1, self.seconds)

    def _learn(self, batch: Batch, loss: Loss[Batch], done: float) -> dict[str, Tensor]:
        for group in self.optimizer.param_groups:
            group["lr"] = self.schedule.learning_rate(self.step, done)
        losses = loss(self.net, batch)
        self.optimizer.zero_grad(set_to_none=True)
        losses["total"].backward()
        torch.nn.utils.clip_grad_norm_(self.net.parameters(), 1.0)
        self.optimizer.step()
        self.step += 1
        self._follow()
        return {name: value.detach() for name, value in losses.items()}

    @torch.no_grad()
    def _follow(self) -> None:
        """Move the running mean; its memory grows with the number of steps."""
        keep = min(1 - 1 / self.schedule.memory, (1 + self.step) / (10 + self.step))
        pairs = zip(self.mean.state_dict().values(), self.net.state_dict().values(), strict=True)
        moving = []
        for slow, fast in pairs:
            if slow.dtype.is_floating_point:
                moving.append((slow, fast))
            else:
                slow.copy_(fast)
        slow, fast = (list(side) for side in zip(*moving, strict=True))
        torch._foreach_lerp_(slow, fast, 1 - keep)

    def _log(self, figures: dict[str, Any]) -> None:
        with (self.folder / LOG).open("a", encoding="utf-8") as log:
            log.write(json.dumps(figures) + "\n")


class _Running:
    """Means of the losses over about the last fifty steps."""

    def __init__(self) -> None:
        self._parts: dict[str, Tensor] = {}

    def add(self, losses: dict[str, Tensor]) -> None:
        for name, value in losses.items():  # read later: to ask a GPU for a number is to wait
            self._parts[name] = self._parts.get(name, value) * 0.98 + 0.02 * value

    def means(self) -> dict[str, float]:
        return {f"train_{name}": round(float(value), 5) for name, value in self._parts.items()}
