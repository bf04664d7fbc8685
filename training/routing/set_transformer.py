"""The routing network: a set transformer over half-branches whose attention stays local.

As in "Stroke Vectorization via Involution Prediction" (routing network) every half-branch is a
token, four pre-norm layers let tokens look at each other, and a head gives a symmetric score for
each pair that shares a junction. Two things differ. A token attends to the half-branches of its
own junction, hears from the other end of its own branch and gets the mean token of its page, so
that n layers see n branches far, and how the artist draws, at a cost that grows linearly with the
drawing. And each pair has features of its own (one half-branch seen in the frame of the other),
which steer the attention and feed the head.
"""

from __future__ import annotations

import torch
from involute.engine.routing.encoding import PAIR_SIZE, TOKEN_SIZE
from torch import Tensor, nn

_BLOCKED = -1e4


class RoutingNet(nn.Module):
    """Scores of pairs: the log-odds of joining two half-branches against ending both.

    Args:
        width: size of a token; edge: size of a pair; heads, layers: of the transformer.
        dropout: share of what a layer adds that is left out at random, in training only.
    """

    def __init__(
        self, width: int = 64, edge: int = 32, heads: int = 4, layers: int = 4, dropout: float = 0.0
    ) -> None:
        super().__init__()
        self.config = {"width": width, "edge": edge, "heads": heads, "layers": layers}
        self.token = nn.Sequential(nn.Linear(TOKEN_SIZE, width), nn.ReLU(), nn.Linear(width, width))
        self.pair = nn.Linear(PAIR_SIZE, width)
        self.pair_from = nn.Linear(width, width, bias=False)
        self.pair_to = nn.Linear(width, width, bias=False)
        self.pair_out = nn.Linear(width, edge)
        self.alone = nn.Parameter(torch.zeros(1, width))
        self.layers = nn.ModuleList(_Layer(width, edge, heads, dropout) for _ in range(layers))
        self.last = nn.LayerNorm(width)
        self.head_pair = nn.Linear(edge, width)
        self.head_sum = nn.Linear(width, width, bias=False)
        self.head_product = nn.Linear(width, width, bias=False)
        self.score = nn.Linear(width, 1)

    def forward(
        self,
        tokens: Tensor,
        pairs: Tensor,
        sibling: Tensor,
        mask: Tensor,
        page: Tensor | None = None,
    ) -> Tensor:
        """Score all pairs of a drawing.

        Args:
            tokens: (J, D, TOKEN_SIZE); pairs: (J, D, D, PAIR_SIZE).
            sibling: (J * D,) flat slot of the other end of the branch; J * D = none.
            mask: (J, D), 1 where a slot is filled.
            page: (J,) the page that each junction is on; None = all are on one page.

        Returns:
            (J, D, D) symmetric scores; those of empty slots mean nothing.
        """
        x = self.token(tokens)
        e = torch.relu(
            self.pair(pairs) + self.pair_from(x).unsqueeze(2) + self.pair_to(x).unsqueeze(1)
        )
        e = torch.relu(self.pair_out(e + e.transpose(1, 2)))
        blocked = (1.0 - mask)[:, None, None, :] * _BLOCKED
        for layer in self.layers:
            x = layer(x, e, blocked, sibling, self.alone)
            x = x + layer.overview(_page_mean(x, mask, page))
        x = self.last(x)
        a, b = x.unsqueeze(2), x.unsqueeze(1)
        z = self.head_pair(e) + self.head_sum(a + b) + self.head_product(a * b)
        return self.score(torch.relu(z)).squeeze(-1)


def _page_mean(x: Tensor, mask: Tensor, page: Tensor | None) -> Tensor:
    """The mean token of each junction's page, (J, 1, width): how this artist draws."""
    total, count = (x * mask.unsqueeze(-1)).sum(1), mask.sum(1, keepdim=True)
    if page is None:
        return (total.sum(0, keepdim=True) / count.sum(0, keepdim=True)).unsqueeze(1)
    # As many pages as junctions at most: to ask a GPU how many there are would make it wait.
    total = torch.zeros_like(total).index_add(0, page, total)
    count = torch.zeros_like(count).index_add(0, page, count)
    return (total / count.clamp(min=1))[page].unsqueeze(1)


class _Layer(nn.Module):
    """Attention inside each junction, then a word with the other end of the branch."""

    def __init__(self, width: int, edge: int, heads: int, dropout: float) -> None:
        super().__init__()
        self.heads, self.width = heads, width
        self.drop = nn.Dropout(dropout)
        self.norm = nn.LayerNorm(width)
        self.qkv = nn.Linear(width, 3 * width)
        self.bias = nn.Linear(edge, heads)
        self.out = nn.Linear(width + heads * edge, width)
        self.norm2 = nn.LayerNorm(width)
        self.mix = nn.Sequential(nn.Linear(2 * width, 2 * width), nn.ReLU())
        self.mix_out = nn.Linear(2 * width, width)
        self.overview = nn.Linear(width, width)

    def forward(
        self, x: Tensor, e: Tensor, blocked: Tensor, sibling: Tensor, alone: Tensor
    ) -> Tensor:
        j, d, width = x.shape
        depth = width // self.heads
        qkv = self.qkv(self.norm(x)).reshape(j, d, 3 * self.heads, depth).permute(0, 2, 1, 3)
        q, k, v = qkv.split(self.heads, dim=1)
        logits = q @ k.transpose(2, 3) * depth**-0.5 + self.bias(e).permute(0, 3, 1, 2) + blocked
        attention = torch.softmax(logits, dim=-1)
        heard = (attention @ v).permute(0, 2, 1, 3).reshape(j, d, width)
        seen = (attention.permute(0, 2, 1, 3) @ e).reshape(j, d, -1)
        x = x + self.drop(self.out(torch.cat([heard, seen], dim=-1)))
        y = self.norm2(x)
        other = torch.cat([y.reshape(j * d, width), alone], dim=0)[sibling].reshape(j, d, width)
        return x + self.drop(self.mix_out(self.mix(torch.cat([y, other], dim=-1))))
