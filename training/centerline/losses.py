"""Losses of the centerline, by name, and the sum over all heads."""

from __future__ import annotations

from collections.abc import Callable

import torch
from torch import Tensor
from torch.nn import functional

from .lines_together import UNKNOWN
from .targets import MAX_HALF_WIDTH


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


def relative_error(raw: Tensor, length: Tensor, where: Tensor) -> Tensor:
    """Mean error of a length relative to it and 1 px, weighted by `where`."""
    error = (raw.sigmoid() - length).abs() / (length + 1 / MAX_HALF_WIDTH)
    return (error * where).sum() / (where.sum() + 1)


def doubled_loss(raw: Tensor, two: Tensor, ridge: Tensor) -> Tensor:
    """Cross entropy on ridges and between two lines, where the truth is known; a little off."""
    known = (two - UNKNOWN).abs() > 0.1
    weight = known * torch.maximum(ridge, two).clamp(min=0.02)
    loss = functional.binary_cross_entropy_with_logits(raw, two.round(), weight, reduction="sum")
    return loss / (weight.sum() + 1)


def lifted_loss(raw: Tensor, lifted: Tensor, ridge: Tensor) -> Tensor:
    """Cross entropy along the lines; a little off. Ends are rare: they count three times."""
    weight = (ridge + 2 * lifted).clamp(min=0.02)
    loss = functional.binary_cross_entropy_with_logits(raw, lifted, weight, reduction="sum")
    return loss / (weight.sum() + 1)


def total_loss(raw: Tensor, truth: Tensor, centerline: str = "bce_dice") -> dict[str, Tensor]:
    """Loss of each head, weighted so that the centerline leads, and "total".

    raw and truth: (N, 9, H, W), channels as in unet.HEADS. Half-width and apart are shares of
    MAX_HALF_WIDTH; they count on the ridge alone, apart on doubled ones.
    """
    line, junctions, endpoints, half, solid, two, apart, clean, lifted = truth.unbind(1)
    seen = raw.contiguous().unbind(1)  # views of their own: the gradient of a slice is a whole map
    ridge = line * (line > 0.2)
    parts = {
        "centerline": CENTERLINE_LOSSES[centerline](seen[0], line),
        "junctions": 0.5 * weighted_bce(seen[1], junctions, 10.0),
        "endpoints": 0.3 * weighted_bce(seen[2], endpoints, 10.0),
        "half_width": 0.3 * relative_error(seen[3], half, ridge),
        "solid": functional.binary_cross_entropy_with_logits(seen[4], solid),
        "doubled": 0.3 * doubled_loss(seen[5], two, ridge),
        "apart": 0.3 * relative_error(seen[6], apart, ridge * (two > 0.7)),
        "clean": 0.6 * CENTERLINE_LOSSES[centerline](seen[7], clean),
        "lifted": 0.6 * lifted_loss(seen[8], lifted, clean * (clean > 0.2)),
    }
    parts["total"] = torch.stack(list(parts.values())).sum()
    return parts
