"""Follow the involution: half-branches become strokes.

A stroke grows to both sides of its first branch: from half-branch h to its counterpart h ^ 1 at
the other end of the branch, from there to its partner, and on, until a half-branch is its own
partner (an end) or the walk comes back to where it began (a closed stroke). Every branch lands in
exactly one stroke.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import NamedTuple

from ..values import Array


class Walk(NamedTuple):
    """The half-branches of one stroke in walking order, each entered at its own vertex."""

    halves: tuple[int, ...]
    closed: bool


def walk(partner: Array, branches: Iterable[int] | None = None) -> list[Walk]:
    """The strokes that an involution makes.

    The order and direction depend on the involution alone: strokes are sorted by their lowest
    branch and begin at the end with the lower half-branch (closed ones at their lowest branch).

    Args:
        partner: (2B,) involution of half-branches.
        branches: only the strokes through these; None = all.
    """
    mate = partner.tolist()
    done = bytearray(len(mate) // 2)
    strokes = []
    for branch in range(len(done)) if branches is None else sorted(set(branches)):
        if done[branch]:
            continue
        forward, closed = _follow(mate, 2 * branch)
        if closed:
            first = min(range(len(forward)), key=lambda k: forward[k] >> 1)
            halves = forward[first:] + forward[:first]
            if halves[0] & 1:
                halves = [halves[0] ^ 1] + [h ^ 1 for h in halves[:0:-1]]
        else:
            backward, _ = _follow(mate, 2 * branch + 1)
            halves = [h ^ 1 for h in backward[:0:-1]] + forward
            if halves[0] > halves[-1] ^ 1:
                halves = [h ^ 1 for h in reversed(halves)]
        for half in halves:
            done[half >> 1] = 1
        strokes.append(Walk(tuple(halves), closed))
    return (
        strokes
        if branches is None
        else sorted(strokes, key=lambda stroke: min(h >> 1 for h in stroke.halves))
    )


def _follow(mate: list[int], half: int) -> tuple[list[int], bool]:
    """The half-branches entered from `half` on, and whether the walk came back to it."""
    start, path = half, []
    while True:
        path.append(half)
        leaving = half ^ 1
        half = mate[leaving]
        if half == leaving:
            return path, False
        if half == start:
            return path, True
