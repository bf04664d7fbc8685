"""Batches on the device that trains: new ones as they are made, and those of before once more.

A GPU learns several times faster than a few processes make pages. So the last batches stay in its
memory, and every step takes some of them at random.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, fields, replace
from threading import Event, Thread

import numpy as np
import torch
from torch import Tensor

from .graph_bank import Batch

_FIRST = 20  # batches that are waited for


@dataclass(frozen=True)
class Supply:
    """What a training takes its batches from.

    batches: an endless stream of new ones. device: where they go. together: how many make one
    step's. kept: how many are kept to be taken again; 0 = each is used once, as it comes.
    """

    batches: Iterable[Batch]
    device: str
    together: int = 1
    kept: int = 0
    seed: int = 0

    def __iter__(self) -> Iterator[Batch]:
        if not self.kept:
            for batch in self.batches:
                yield on_device(batch, self.device)
        rng = np.random.default_rng(self.seed)
        stock, ready = deque[Batch](maxlen=self.kept), Event()
        source = iter(self.batches)  # its processes are made by the main thread
        Thread(target=self._fill, args=(source, stock, ready), daemon=True).start()
        ready.wait()
        while True:
            now = list(stock)
            slots = now[int(rng.integers(len(now)))].mask.shape[1]
            alike = [batch for batch in now if batch.mask.shape[1] == slots]
            yield together([alike[k] for k in rng.integers(len(alike), size=self.together)])

    def _fill(self, source: Iterator[Batch], stock: deque[Batch], ready: Event) -> None:
        try:
            for batch in source:
                stock.append(on_device(batch, self.device))
                if len(stock) >= min(_FIRST, self.kept):
                    ready.set()
        finally:
            ready.set()  # where no more come, those that are there must do


def on_device(batch: Batch, device: str) -> Batch:
    """The same batch as tensors."""
    tensors = {one.name: torch.as_tensor(getattr(batch, one.name)) for one in fields(batch)}
    return Batch(**{name: value.to(device) for name, value in tensors.items()})


def together(parts: list[Batch]) -> Batch:
    """Several batches of tensors with the same number of slots as one."""
    total = sum(part.mask.numel() for part in parts)
    siblings: list[Tensor] = []
    pages: list[Tensor] = []
    start, first = 0, 0
    for part in parts:
        size = part.mask.numel()
        siblings.append(torch.where(part.sibling >= size, total, part.sibling + start))
        pages.append(part.page + first)
        start, first = start + size, first + len(part.page)
    names = ("tokens", "pairs", "mask", "truth", "asked")
    arrays = {name: torch.cat([getattr(part, name) for part in parts]) for name in names}
    return replace(parts[0], sibling=torch.cat(siblings), page=torch.cat(pages), **arrays)
