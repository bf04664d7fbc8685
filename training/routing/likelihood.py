"""Two ways to say how wrong a table of pair scores is.

`exact`: the likelihood of the true involution of each junction, all involutions enumerated.
`sinkhorn`: the loss of "Stroke Vectorization via Involution Prediction" (routing network):
symmetric Gumbel noise, Sinkhorn iterations, cross-entropy and the Frobenius distance.
"""

from __future__ import annotations

from functools import cache

import numpy as np
import torch
from involute.engine.involution import pair_matrix
from torch import Tensor

_BLOCKED = -1e4


def exact(scores: Tensor, mask: Tensor, truth: Tensor) -> Tensor:
    """(J,) negative log-likelihood of the truth, a (J, D, D) symmetric 0/1 matrix of pairs.

    Where pairs of the truth contradict each other, every involution that keeps as many of them as
    can be counts as right.
    """
    degrees = mask.sum(1).long()
    loss = scores.new_zeros(len(scores))
    for degree in range(3, scores.shape[1] + 1):
        rows = torch.nonzero(degrees == degree)[:, 0]
        if len(rows):
            a, b = np.triu_indices(degree, 1)
            ways = _ways(degree, str(scores.device))
            total = scores[rows][:, a, b] @ ways.T
            real = truth[rows][:, a, b]
            kept = real @ ways.T - (1 - real) @ ways.T * degree
            right = kept == kept.amax(1, keepdim=True)
            best = torch.logsumexp(total.masked_fill(~right, _BLOCKED), dim=1)
            loss = loss.index_add(0, rows, torch.logsumexp(total, dim=1) - best)
    return loss


@cache
def _ways(degree: int, device: str) -> Tensor:
    return torch.from_numpy(pair_matrix(degree)).to(device)


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
