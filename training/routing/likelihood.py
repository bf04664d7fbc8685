"""Two ways to say how wrong a table of pair scores is.

`exact`: the likelihood of the true involution of each junction, all involutions enumerated.
`sinkhorn`: the loss of "Stroke Vectorization via Involution Prediction" (routing network):
symmetric Gumbel noise, Sinkhorn iterations, cross-entropy and the Frobenius distance.
"""

from __future__ import annotations

from functools import cache

import numpy as np
import torch
from involute.engine.routing.encoding import MAX_DEGREE
from torch import Tensor

_BLOCKED = -1e4


@cache
def involutions(degree: int) -> np.ndarray:
    """(N, degree, degree) float32: all symmetric 0/1 matrices of disjoint pairs, zero diagonal."""

    def grow(free: tuple[int, ...]) -> list[list[tuple[int, int]]]:
        if not free:
            return [[]]
        a, rest = free[0], free[1:]
        found = grow(rest)
        for k, b in enumerate(rest):
            found += [[(a, b), *more] for more in grow(rest[:k] + rest[k + 1 :])]
        return found

    ways = grow(tuple(range(degree)))
    table = np.zeros((len(ways), degree, degree), np.float32)
    for row, pairs in enumerate(ways):
        for a, b in pairs:
            table[row, a, b] = table[row, b, a] = 1
    return table


def log_probabilities(scores: Tensor, degree: int) -> Tensor:
    """(J, N) log-probability of each of the N involutions of junctions of one degree."""
    table = torch.from_numpy(involutions(degree)).to(scores.device).reshape(-1, degree * degree)
    total = scores[:, :degree, :degree].reshape(len(scores), -1) @ table.T / 2
    return torch.log_softmax(total, dim=1)


def exact(scores: Tensor, mask: Tensor, truth: Tensor) -> Tensor:
    """(J,) negative log-likelihood of the truth, a (J, D, D) symmetric 0/1 matrix of pairs."""
    degrees = mask.sum(1).long()
    loss = scores.new_zeros(len(scores))
    right = (scores * truth).sum((1, 2)) / 2
    for degree in range(3, MAX_DEGREE + 1):
        rows = torch.nonzero(degrees == degree)[:, 0]
        if len(rows):
            table = torch.from_numpy(involutions(degree)).to(scores.device)
            some = scores[rows][:, :degree, :degree].reshape(len(rows), -1)
            total = torch.logsumexp(some @ table.reshape(len(table), -1).T / 2, dim=1)
            loss = loss.index_add(0, rows, total - right[rows])
    return loss


def sinkhorn(scores: Tensor, mask: Tensor, truth: Tensor, rounds: int = 20) -> Tensor:
    """(J,) the paper's loss; the end of a half-branch is the diagonal, with score 0."""
    eye = torch.eye(scores.shape[1], device=scores.device)
    both = mask[:, :, None] * mask[:, None, :]
    noise = torch.rand_like(scores).clamp(1e-6, 1 - 1e-6).log().neg().log().neg()
    noise = noise.triu() + noise.triu(1).transpose(1, 2)
    table = torch.where(both > 0, scores / 2 * (1 - eye) + noise, _BLOCKED)
    for _ in range(rounds):
        table = table - torch.logsumexp(table, dim=2, keepdim=True)
        table = table - torch.logsumexp(table, dim=1, keepdim=True)
    table = torch.where(both > 0, table, _BLOCKED)
    ends = (1 - truth.sum(2)) * mask
    target = truth + torch.diag_embed(ends)
    entropy = -(target * table.clamp(min=-20)).sum((1, 2)) / mask.sum(1)
    distance = ((table.exp() - target) ** 2 * both).sum((1, 2)).clamp(min=1e-9).sqrt()
    return entropy + distance
