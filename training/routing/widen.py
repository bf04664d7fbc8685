"""A network twice as wide that gives the same scores: what was learnt is not learnt anew.

After "Net2Net: Accelerating Learning via Knowledge Transfer" (2016): every unit stands twice, and
what a unit heard from one it now hears from both copies, a random part from each, so that the
copies learn different things from then on.
"""

from __future__ import annotations

from typing import Any

import torch
from torch import Tensor

from .set_transformer import RoutingNet

_UNEVEN = 0.2  # how unevenly a unit hears its two sources, relative to their mean


def widened(net: RoutingNet, dropout: float = 0.0) -> RoutingNet:
    """The same function in a network of double width and edge."""
    width, edge, heads = (net.config[name] for name in ("width", "edge", "heads"))
    depth = width // heads
    config: dict[str, Any] = net.config | {"width": 2 * width, "edge": 2 * edge, "dropout": dropout}
    wide = RoutingNet(**config)
    state = {}
    for name, weight in net.state_dict().items():
        kind = name.rpartition(".")[0].split(".")[-1]
        if kind == "qkv":
            # Scores of attention grow with the depth of a head, but for its square root.
            queries = torch.arange(3 * width) < width
            shrink = torch.where(queries, 0.5**0.5, 1.0)
            weight = weight * (shrink[:, None] if weight.dim() == 2 else shrink)
        if name == "alone":
            weight = weight.repeat(1, 2)
        elif kind not in ("score", "bias"):  # one score a pair, one bias a head: as before
            weight = _twice(weight, depth if kind == "qkv" else len(weight))
        if name.endswith(".weight") and weight.dim() == 2 and name not in _FIRST:
            parts = [width, heads * edge] if kind == "out" else [weight.shape[1]]
            blocks = [depth, edge] if kind == "out" else [weight.shape[1]]
            if name.endswith("mix.0.weight"):
                parts, blocks = [width, width], [width, width]
            columns = weight.split(parts, 1)
            weight = torch.cat([_shared(c, b) for c, b in zip(columns, blocks, strict=True)], 1)
        state[name] = weight
    wide.load_state_dict(state)
    return wide


# The weights of these see the features of the graph, which do not double.
_FIRST = ("token.0.weight", "pair.weight")


def _twice(weight: Tensor, block: int) -> Tensor:
    """Every run of `block` rows two times."""
    runs = weight.reshape(-1, block, *weight.shape[1:])
    return torch.cat([runs, runs], 1).reshape(-1, *weight.shape[1:])


def _shared(weight: Tensor, block: int) -> Tensor:
    """Every run of `block` columns split over two copies of it."""
    runs = weight.reshape(len(weight), -1, block)
    part = 0.5 + 0.5 * _UNEVEN * torch.randn_like(runs)
    return torch.cat([runs * part, runs * (1 - part)], 2).reshape(len(weight), -1)
