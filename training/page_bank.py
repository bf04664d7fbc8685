"""Results of many numbered pages, made by parallel processes and kept in a file as they come."""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from multiprocessing import get_context
from pathlib import Path
from typing import Any, Generic, TypeVar

import numpy as np

Array = np.ndarray
Labelled = tuple[Array, Array]
Result = TypeVar("Result")


@dataclass(frozen=True)
class PageBank(Generic[Result]):
    """How the results of pages are kept.

    path: a .npz file. load: gives all results and how many pages were tried; save: writes them.
    piece: pages between two writings.
    """

    path: Path
    load: Callable[[Path], tuple[list[Result], int]]
    save: Callable[[Path, list[Result], int], None]
    piece: int

    def filled(
        self,
        pages: int,
        make: Callable[[int], Result | None],
        jobs: int = 1,
        prepare: Callable[..., None] | None = None,
        work: tuple[Any, ...] = (),
        seconds: float = math.inf,
    ) -> list[Result]:
        """The results of so many pages: those in the file, and the rest made and added to it.

        make(number) gives the result of a page, or None when it comes to nothing; it and
        prepare(*work), which every process calls once, are functions of a module. After so many
        seconds no more are made; what is there is written.
        """
        results, tried = self.load(self.path) if self.path.exists() else ([], 0)
        if tried >= pages:
            return results
        until = time.monotonic() + seconds
        with ProcessPoolExecutor(jobs, get_context("spawn"), prepare, work) as pool:
            for found in pool.map(make, range(tried, pages)):
                tried += 1
                results += [] if found is None else [found]
                late = time.monotonic() > until
                if tried % self.piece == 0 or tried == pages or late:
                    self._write(results, tried)
                    print(f"{self.path.name}: {len(results)} of {tried} pages", flush=True)
                if late:
                    pool.shutdown(cancel_futures=True)
                    break
        return results

    def _write(self, results: list[Result], tried: int) -> None:
        part = self.path.with_suffix(".part.npz")
        self.save(part, results, tried)
        part.replace(self.path)


def labelled_rows(
    path: Path,
    pages: int,
    jobs: int,
    make: Callable[[int], Labelled | None],
    prepare: Callable[..., None],
    work: tuple[Any, ...],
    piece: int,
) -> Labelled:
    """Features (N, F) and labels (N,) of so many pages, from a file or made; see `PageBank`."""
    found = PageBank(path, _read, _save, piece).filled(pages, make, jobs, prepare, work)
    return np.concatenate([rows for rows, _ in found]), np.concatenate([own for _, own in found])


def _read(path: Path) -> tuple[list[Labelled], int]:
    with np.load(path) as saved:
        return [(saved["rows"], saved["labels"])], int(saved["pages"])


def _save(path: Path, found: list[Labelled], pages: int) -> None:
    rows, labels = (np.concatenate(part) for part in zip(*found, strict=True))
    np.savez_compressed(path, rows=rows, labels=labels, pages=pages)
