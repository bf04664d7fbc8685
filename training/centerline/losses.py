"""Losses of the centerline, by name, and the sum over all heads."""

from __future__ import annotations

from collections.abc import Callable

import torch
from torch import Tensor
from torch.nn import functional

from .targets import MAX_HALF_WIDTH
from .unet import HEADS


def paper_loss(raw: Tensor, truth: Tensor) -> Tensor:
    """Mean squared error and 0.001 of bimodality p (1 - p): the paper's equation (1)."""
    p = raw.sigmoid()
    return functional.mse_loss(p, truth) + 0.001 * (p * (1 - p)).mean()


def weighted_bce(raw: Tensor, truth: Tensor, weight: float = 4.0) -> Tensor:
    """Cross entropy in which a pixel on a line counts 1 + weight times."""
    loss = functional.binary_cross_entropy_with_logits(raw, truth, weight=1 + weight * truth)
    return 5.0 * loss


def soft_dice(raw: Tensor, truth: Tensor) -> Tensor:
    """1 - overlap of prediction and truth over the whole batch; squared sums keep soft truths."""
    p = raw.sigmoid()
    overlap = 2 * (p * truth).sum() + 1
    return 1 - overlap / ((p * p).sum() + (truth * truth).sum() + 1)


def bce_dice(raw: Tensor, truth: Tensor) -> Tensor:
    """Weighted cross entropy plus soft Dice."""
    return weighted_bce(raw, truth) + soft_dice(raw, truth)


CENTERLINE_LOSSES: dict[str, Callable[[Tensor, Tensor], Tensor]] = {
    "paper": paper_loss,
    "bce": weighted_bce,
    "bce_dice": bce_dice,
}


def total_loss(raw: Tensor, truth: Tensor, centerline: str = "bce_dice") -> dict[str, Tensor]:
    """Loss of each head, weighted so that the centerline leads, and "total".

    raw and truth: (N, 5, H, W), channels as in model.HEADS. The truth's half-width is a share of
    MAX_HALF_WIDTH; it counts on the ridge alone.
    """
    line, junctions, endpoints, half, solid = (truth[:, k] for k in range(len(HEADS)))
    ridge = line * (line > 0.2)
    error = (raw[:, 3].sigmoid() - half).abs() / (half + 1 / MAX_HALF_WIDTH)
    parts = {
        "centerline": CENTERLINE_LOSSES[centerline](raw[:, 0], line),
        "junctions": 0.5 * weighted_bce(raw[:, 1], junctions, 10.0),
        "endpoints": 0.3 * weighted_bce(raw[:, 2], endpoints, 10.0),
        "half_width": 0.3 * (error * ridge).sum() / (ridge.sum() + 1),
        "solid": functional.binary_cross_entropy_with_logits(raw[:, 4], solid),
    }
    parts["total"] = torch.stack(list(parts.values())).sum()
    return parts
