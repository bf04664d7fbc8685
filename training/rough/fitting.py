"""Rows of features with their labels, and the small perceptrons that learn from them."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import torch
from torch import nn

Array = np.ndarray
Rows = tuple[Array, Array]
Net = dict[str, Array]

_BATCH, _NOISE, _DROPOUT = 1024, 0.1, 0.2
_EVERY = 75  # steps between two looks at the held-out pages


def none(features: int) -> Rows:
    return np.zeros((0, features)), np.zeros(0, bool)


def stacked(parts: list[Rows]) -> Rows:
    return np.concatenate([p[0] for p in parts]), np.concatenate([p[1] for p in parts])


def fitted(
    rows: Rows, held: Rows, hidden: tuple[int, ...], steps: int
) -> tuple[Net, dict[str, float]]:
    """A perceptron that is best on the held-out rows, as `engine.rough.grouping` reads it."""
    mean, spread = rows[0].mean(0), rows[0].std(0) + 1e-3

    def tensors(part: Rows) -> tuple[torch.Tensor, torch.Tensor]:
        scaled = np.clip((part[0] - mean) / spread, -4, 4).astype(np.float32)
        return torch.from_numpy(scaled), torch.from_numpy(part[1].astype(np.float32))

    (x, y), (held_x, held_y) = tensors(rows), tensors(held)
    layers: list[nn.Module] = []
    sizes = [x.shape[1], *hidden]
    for a, b in pairwise(sizes):
        layers += [nn.Linear(a, b), nn.ReLU(), nn.Dropout(_DROPOUT)]
    net = nn.Sequential(*layers, nn.Linear(sizes[-1], 1))
    optimizer = torch.optim.AdamW(net.parameters(), lr=3e-3, weight_decay=0.05)
    plan = torch.optim.lr_scheduler.OneCycleLR(optimizer, 3e-3, total_steps=steps)
    lost = nn.functional.binary_cross_entropy_with_logits
    best, kept = np.inf, net.state_dict()
    for step in range(steps):
        pick = torch.randint(len(x), (_BATCH,))
        loss = lost(net(x[pick] + _NOISE * torch.randn(_BATCH, x.shape[1]))[:, 0], y[pick])
        optimizer.zero_grad()
        loss.backward()
        optimizer.step()
        plan.step()
        if step % _EVERY == _EVERY - 1 or step == steps - 1:
            net.eval()
            with torch.no_grad():
                judged = float(lost(net(held_x)[:, 0], held_y))
            net.train()
            if judged < best:
                best, kept = judged, {k: v.clone() for k, v in net.state_dict().items()}
    net.load_state_dict(kept)
    net.eval()
    with torch.no_grad():
        right = ((net(held_x)[:, 0] > 0) == (held_y > 0.5)).float().mean()
    figure = {
        "rows": len(x),
        "held-out rows": len(held_x),
        "true": round(float(held_y.mean()), 3),
        "loss": round(best, 4),
        "right": round(float(right), 4),
    }
    found = {"mean": mean, "spread": spread}
    for number, layer in enumerate(m for m in net if isinstance(m, nn.Linear)):
        found[f"weight{number}"] = layer.weight.detach().numpy().T
        found[f"bias{number}"] = layer.bias.detach().numpy()
    return {name: np.ascontiguousarray(v, np.float32) for name, v in found.items()}, figure
