"""Pages for several trainings at once: some processes draw, into a folder that all learn from.

    python -m involute.training.centerline.shared_pages --data DATA --out FOLDER --jobs 9

draws until it is stopped; once FOLDER (in memory, best) holds `--keep` pages, new ones take the
place of the oldest. `train_centerline --shared FOLDER` cuts its crops from them.
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Iterator, Sequence
from itertools import cycle
from multiprocessing import get_context, parent_process
from pathlib import Path

import cv2
import numpy as np
import torch
from torch import Tensor
from torch.utils.data import get_worker_info

from ...synthesis.line_art import Array
from .page_batches import STREAMS, Pages

_FEWEST = 100  # pages that are waited for
_LOOK = 20  # batches between two looks at which pages there are


def main(argv: Sequence[str] | None = None) -> None:
    """The command line."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--data", type=Path, required=True, help="folder with the true drawings")
    parser.add_argument("--out", type=Path, required=True)
    parser.add_argument("--pages", default="clean", choices=list(STREAMS), help="what is on them")
    parser.add_argument("--side", type=int, default=512, help="of a page, px")
    parser.add_argument("--keep", type=int, default=9000, help="pages; one of 512 px is 2.6 MB")
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args(argv)
    options.out.mkdir(parents=True, exist_ok=True)
    context = get_context("spawn")
    drawing = [context.Process(target=draw, args=(options, job)) for job in range(options.jobs)]
    for process in drawing:
        process.start()
    for process in drawing:
        process.join()


def draw(options: argparse.Namespace, job: int) -> None:
    """Draw pages as long as whoever asked is there, each written beside and moved into place."""
    cv2.setNumThreads(1)
    rng = np.random.default_rng((options.seed, job))
    stream = STREAMS[options.pages]
    library = stream.load(options.data)
    part = options.out / f"{job}.part"
    asked = parent_process()
    for number in cycle(range(job, options.keep, options.jobs)):
        if asked and not asked.is_alive():
            return
        with part.open("wb") as file:
            np.save(file, stream.draw(rng, library, options.side, False))
        part.replace(options.out / f"{number}.npy")


class SharedPages(Pages):
    """The same batches, of pages that other processes draw into a folder."""

    def __init__(self, folder: Path, batch: int, crop: int, side: int, seed: int) -> None:
        super().__init__(folder, batch, crop, 0, seed, side)
        self.folder = folder

    def __iter__(self) -> Iterator[Tensor]:
        worker = get_worker_info()
        rng = np.random.default_rng((self.seed, worker.id if worker else 0))
        torch.set_num_threads(1)
        while len(there := self._pages()) < _FEWEST:
            time.sleep(0.5)
        while True:
            for _ in range(_LOOK):
                chosen = (there[k] for k in rng.integers(0, len(there), self.batch))
                crops = [self._crop(rng, _read(path)) for path in chosen]
                yield torch.from_numpy(np.stack(crops))
            there = self._pages()

    def _pages(self) -> list[Path]:
        return list(self.folder.glob("*.npy"))


def _read(path: Path) -> Array:
    found: Array = np.load(path, mmap_mode="r")
    return found


if __name__ == "__main__":
    main()
