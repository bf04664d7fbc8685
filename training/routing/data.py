"""Batches for the routing network: pages from a bank that is renewed while training runs."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from involute.engine.routing.encoding import Encoding, encode

from .augment import Page, augmented, random_fixed
from .pages import Library, loosened
from .planar import graph_from_strokes

Array = np.ndarray


@dataclass(frozen=True, eq=False)
class Batch:
    """Junctions of several pages: the arrays of `Encoding`, the truth, and which were fixed.

    truth: (J, D, D) float32 symmetric 0/1; asked: (J,) float32, 0 where the truth was given away.
    """

    tokens: Array
    pairs: Array
    sibling: Array
    mask: Array
    truth: Array
    asked: Array


def true_page(strokes: list[Array]) -> Page:
    """The planar graph of pen strokes as a page that remembers which stroke each point is of."""
    graph, partner = graph_from_strokes(strokes, strength=np.arange(len(strokes)))
    stroke = np.zeros(0) if graph.strength is None else graph.strength
    return Page(replace(graph, strength=None), partner, stroke)


def truth_of(page: Page, encoding: Encoding) -> Array:
    """(J, D, D) float32, 1 where the pen ran from one half-branch into the other."""
    halves = encoding.halves
    if not halves.size:
        return np.zeros((*halves.shape, halves.shape[1]), np.float32)
    other = np.where(halves >= 0, page.partner[halves], -2)
    same = (other[:, :, None] == halves[:, None, :]) & (other != halves)[:, :, None]
    return same.astype(np.float32)


class Bank:
    """A stock of graphs; each visit varies one of them, and now and then one is replaced.

    Cutting strokes into a graph costs more than varying it, and variations of a page teach nearly
    as much as a new page.
    """

    def __init__(self, library: Library, seed: int, size: int = 2000, renew: float = 0.2) -> None:
        self.library, self.size, self.renew = library, size, renew
        self.rng = np.random.default_rng(seed)
        self.pages: list[Page] = []

    def page(self) -> Page:
        if len(self.pages) < self.size or self.rng.random() < self.renew:
            page = true_page(loosened(self.rng, self.library.page(self.rng)))
            if not len(page.graph.junctions):
                return self.page()
            if len(self.pages) < self.size:
                self.pages.append(page)
            else:
                self.pages[int(self.rng.integers(self.size))] = page
            return page
        return self.pages[int(self.rng.integers(len(self.pages)))]

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


def encoded(page: Page, fixed: dict, slots: int) -> Batch:
    """One page as a batch."""
    encoding = encode(page.graph, fixed, slots)
    known = page.graph.junctions[sorted(fixed)]
    vertex = page.graph.half_vertex[encoding.halves[:, 0]]
    return Batch(
        encoding.tokens,
        encoding.pairs,
        encoding.sibling.reshape(-1),
        encoding.mask,
        truth_of(page, encoding),
        1.0 - np.isin(vertex, known).astype(np.float32),
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
    return Batch(sibling=np.concatenate(siblings), **arrays)
