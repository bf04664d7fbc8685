"""Batches for the routing network: pages from a bank that is renewed while training runs."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import torch
from involute.engine.routing.encoding import Encoding, encode
from involute.synthesis.composed_pages import Library, loosened
from involute.synthesis.true_graph import graph_from_strokes
from torch.utils.data import DataLoader, IterableDataset, get_worker_info

from .augment import Page, augmented, random_fixed
from .page_file import load

Array = np.ndarray

_STOCK = 2000  # pages kept
_RENEW = 0.2  # how often a visit brings a new page


@dataclass(frozen=True, eq=False)
class Batch:
    """Junctions of several pages: the arrays of `Encoding`, the truth, and which were fixed.

    truth: (J, D, D) float32 symmetric 0/1; asked: (J,) float32, 0 where the truth was given away;
    page: (J,) int64, which page of the batch a junction is on.
    """

    tokens: Array
    pairs: Array
    sibling: Array
    mask: Array
    truth: Array
    asked: Array
    page: Array


def true_page(strokes: list[Array]) -> Page:
    """The planar graph of pen strokes as a page that remembers which stroke each point is of."""
    graph, partner = graph_from_strokes(strokes, strength=np.arange(len(strokes)))
    stroke = np.zeros(0) if graph.strength is None else graph.strength
    return Page(replace(graph, strength=None), partner, stroke)


def truth_of(page: Page, encoding: Encoding) -> Array:
    """(J, D, D) float32, 1 where the pen ran from one half-branch into the other."""
    halves = encoding.halves
    truth = np.zeros((*halves.shape, halves.shape[1]), np.float32)
    own = np.arange(len(page.partner))
    pairs = np.stack([own, page.partner], 1)[page.partner > own]
    slot = np.full(len(page.partner), -1)
    slot[halves[halves >= 0]] = np.flatnonzero(halves >= 0)
    a, b = slot[pairs[(slot[pairs] >= 0).all(1)]].T
    row, a, b = a // halves.shape[1], a % halves.shape[1], b % halves.shape[1]
    truth[row, a, b] = truth[row, b, a] = 1
    return truth


class Bank:
    """A stock of graphs; each visit varies one of them, and now and then one is replaced.

    Cutting strokes into a graph costs more than varying it, and variations of a page teach nearly
    as much as a new page.
    """

    def __init__(
        self,
        library: Library,
        seed: int | tuple[int, ...],
        traced: list[Page] | None = None,
        share: float = 0.0,
    ) -> None:
        self.library, self.traced = library, traced or []
        self.share = share if self.traced else 0.0
        self.rng = np.random.default_rng(seed)
        self.pages: list[Page] = []

    def page(self) -> Page:
        """A traced page with probability `share`, else one of the stock or a new one."""
        if self.rng.random() < self.share:
            return self.traced[int(self.rng.integers(len(self.traced)))]
        if self.pages and self.rng.random() > _RENEW:
            return self.pages[int(self.rng.integers(len(self.pages)))]
        page = true_page(loosened(self.rng, self.library.page(self.rng)))
        if not len(page.graph.junctions):
            return self.page()
        if len(self.pages) < _STOCK:
            self.pages.append(page)
        else:
            self.pages[int(self.rng.integers(_STOCK))] = page
        return page

    def batch(self, junctions: int, slots: int) -> Batch:
        """A batch of about so many junctions; half of the pages with some of them fixed."""
        parts, count = [], 0
        while count < junctions:
            page = augmented(self.rng, self.page())
            share = self.rng.uniform(0, 0.7) if self.rng.random() < 0.5 else 0.0
            part = encoded(page, random_fixed(self.rng, page, share), slots)
            if len(part.mask):
                parts.append(part)
                count += len(part.mask)
        return joined(parts)


@dataclass(frozen=True)
class Batches(IterableDataset):
    """An endless stream of `Batch`es of about so many junctions; every worker has its own bank.

    traced: files by `traced`, from which `share` of the pages come.
    """

    data: Path
    traced: tuple[Path, ...]
    share: float
    junctions: int
    seed: int

    def __iter__(self) -> Iterator[Batch]:
        worker = get_worker_info()
        if worker:
            torch.set_num_threads(1)
        traced = [page for file in self.traced for page in load(file)]
        seed = (self.seed, worker.id) if worker else self.seed
        bank = Bank(Library.load(self.data, held_out=False), seed, traced, self.share)
        step = 0
        while True:
            # Junctions of more than six are rare: a wider table is only now and then worth it.
            yield halved(bank.batch(self.junctions, 8 if step % 5 == 0 else 6))
            step += 1

    def loader(self, workers: int) -> DataLoader:
        """Batches made by `workers` processes (0 = in this one)."""
        ahead = 6 if workers else None
        return DataLoader(
            self, batch_size=None, num_workers=workers, prefetch_factor=ahead, collate_fn=_as_it_is
        )


def halved(batch: Batch) -> Batch:
    """The batch in half the memory; what a graph says is not as exact as that by far."""
    return replace(
        batch, tokens=batch.tokens.astype(np.float16), pairs=batch.pairs.astype(np.float16)
    )


def _as_it_is(batch: Batch) -> Batch:
    return batch


def encoded(page: Page, fixed: dict, slots: int) -> Batch:
    """One page as a batch."""
    encoding = encode(page.graph, fixed, slots)
    known = np.zeros(len(page.graph.vertices), bool)
    known[page.graph.junctions[sorted(fixed)]] = True
    vertex = page.graph.half_vertex[encoding.halves[:, 0]]
    return Batch(
        encoding.tokens,
        encoding.pairs,
        encoding.sibling.reshape(-1),
        encoding.mask,
        truth_of(page, encoding),
        1.0 - known[vertex].astype(np.float32),
        np.zeros(len(vertex), np.int64),
    )


def joined(parts: list[Batch]) -> Batch:
    """Several batches with the same number of slots as one."""
    total = sum(part.mask.size for part in parts)
    siblings, start = [], 0
    for part in parts:
        alone = part.sibling >= part.mask.size
        siblings.append(np.where(alone, total, part.sibling + start))
        start += part.mask.size
    names = ("tokens", "pairs", "mask", "truth", "asked")
    arrays = {name: np.concatenate([getattr(part, name) for part in parts]) for name in names}
    page = np.repeat(np.arange(len(parts)), [len(part.mask) for part in parts])
    return Batch(sibling=np.concatenate(siblings), page=page, **arrays)
