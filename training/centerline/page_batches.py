"""Batches for training: pages rendered in worker processes, each page used a few times.

A worker keeps the latest pages in memory, adds `fresh` new ones per batch and cuts turned and
flipped crops out of what it holds: rendering never holds up the training.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import torch
from torch import Tensor
from torch.utils.data import DataLoader, IterableDataset, get_worker_info

from ...synthesis.line_art import Array, Library
from .rough_page import RoughLibrary, rough_page
from .training_page import page

PAGE = 384  # px, side of a page
_FIRST = 24  # pages that a worker draws before its first batch: 5 s
AT_EDGE = 0.15  # share of the crops that show the edge of a page


@dataclass(frozen=True)
class Stream:
    """A kind of pages. load(folder): the drawings; draw(rng, drawings, size, held_out): a page."""

    load: Callable[[Path], Any]
    draw: Callable[[np.random.Generator, Any, int, bool], Array]


STREAMS = {
    "clean": Stream(Library.load, page),
    "rough": Stream(RoughLibrary.load, rough_page),
}


class Pages(IterableDataset):
    """An endless stream of (batch, C, crop, crop) uint8 tensors, channels as sample.CHANNELS."""

    def __init__(
        self,
        data: Path,
        batch: int,
        crop: int,
        fresh: float,
        seed: int,
        side: int = PAGE,
        keep: int = 700,
        stream: str = "clean",
    ) -> None:
        self.stream = STREAMS[stream]
        self.data, self.batch, self.crop = data, batch, crop
        self.fresh, self.seed, self.side, self.keep = fresh, seed, side, keep

    def __iter__(self) -> Iterator[Tensor]:
        worker = get_worker_info()
        rng = np.random.default_rng((self.seed, worker.id if worker else 0))
        torch.set_num_threads(1)
        library = self.stream.load(self.data)

        def drawn() -> Array:
            return self.stream.draw(rng, library, self.side, False)

        held = [drawn() for _ in range(_FIRST)]
        due, slot = 0.0, 0
        while True:
            due += self.fresh
            while due >= 1:
                due -= 1
                if len(held) < self.keep:
                    held.append(drawn())
                else:
                    held[slot % self.keep] = drawn()
                    slot += 1
            crops = [self._crop(rng, held[rng.integers(len(held))]) for _ in range(self.batch)]
            yield torch.from_numpy(np.stack(crops))

    def _crop(self, rng: np.random.Generator, whole: Array) -> Array:
        """A turned or flipped crop, now and then at the page's edge; of two tries the one that
        shows more line."""
        tries, rest = [], self.side - self.crop
        for _ in range(2):
            y, x = rng.integers(0, rest + 1, 2)
            if rng.random() < AT_EDGE:
                y, x = rng.permutation([rng.choice([0, rest]), x])
            tries.append(whole[:, y : y + self.crop, x : x + self.crop])
        best = max(tries, key=lambda crop: int(crop[1].sum())) if rng.random() < 0.7 else tries[0]
        best = np.rot90(best, rng.integers(4), (1, 2))
        return best[:, :, ::-1] if rng.random() < 0.5 else best


def loader(pages: Pages, workers: int, pinned: bool = False) -> DataLoader:
    """Batches made by `workers` processes (0 = in this one); pinned: in memory that a GPU copies
    from while it computes."""
    ahead = 4 if workers else None
    return DataLoader(
        pages, batch_size=None, num_workers=workers, prefetch_factor=ahead, pin_memory=pinned
    )


def validation_pages(
    data: Path, count: int, size: int = PAGE, seed: int = 77, stream: str = "clean"
) -> Array:
    """(count, C, size, size) uint8 pages from the held-out drawings, always the same ones."""
    kind = STREAMS[stream]
    library = kind.load(data)
    rngs = (np.random.default_rng((seed, k)) for k in range(count))
    return np.stack([kind.draw(rng, library, size, True) for rng in rngs])


def split(batch: Tensor) -> tuple[Tensor, Tensor]:
    """uint8 channels -> ink (N, 1, H, W) and truth (N, C - 1, H, W), float32 in [0, 1]."""
    maps = batch.float().div_(255)
    return maps[:, :1].contiguous(memory_format=torch.channels_last), maps[:, 1:]


def degrade(ink: Tensor, generator: torch.Generator) -> Tensor:
    """Cheap last variation of the input, new at every use of a page: ink level and noise."""
    shape = (len(ink), 1, 1, 1)
    draw = torch.rand((3, *shape), generator=generator, device=ink.device)
    level = 1 - 0.3 * draw[0] * (draw[1] < 0.5)
    spread = 0.06 * draw[2] * (draw[1] > 0.6)
    grain = torch.randn(ink.shape, generator=generator, device=ink.device)
    return (ink * level + spread * grain).clamp(0, 1)
