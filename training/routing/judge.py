"""How good scores of pairs are, from the exact probabilities of all involutions of a junction."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import torch

from .likelihood import involutions, log_probabilities

Array = np.ndarray


@dataclass(frozen=True, eq=False)
class Verdict:
    """What was decided at each of J junctions, all arrays (J,).

    true, made, right: pairs in the truth, pairs made, and pairs in both; probability of the
    choice; rank of the truth among the alternatives (0 = chosen); loss, its log-likelihood.
    """

    degree: Array
    true: Array
    made: Array
    right: Array
    probability: Array
    rank: Array
    loss: Array

    @property
    def correct(self) -> Array:
        return self.rank == 0

    def summary(self, keep: Array | None = None) -> dict[str, float]:
        """Rates over the junctions of `keep` (J,) bool, or over all."""
        keep = np.ones(len(self.degree), bool) if keep is None else keep
        true, made, right = (int(v[keep].sum()) for v in (self.true, self.made, self.right))
        return {
            "junctions": int(keep.sum()),
            "pairs_right": right / max(true, 1),
            "pairs_wrong": 1 - right / max(made, 1),
            "junctions_right": float(self.correct[keep].mean()) if keep.any() else 0.0,
            "made_per_true": made / max(true, 1),
            "top2": float((self.rank[keep] < 2).mean()) if keep.any() else 0.0,
            "calibration_error": calibration_error(self.probability[keep], self.correct[keep]),
            "loss": float(self.loss[keep].mean()) if keep.any() else 0.0,
        }


def judge(scores: Array, mask: Array, truth: Array) -> Verdict:
    """Decide every junction by the most probable involution and compare with the truth.

    Args:
        scores, truth: (J, D, D) symmetric; mask: (J, D).
    """
    degrees = mask.sum(1).astype(int)
    out = {name: np.zeros(len(scores)) for name in Verdict.__dataclass_fields__}
    for degree in np.unique(degrees):
        rows = np.flatnonzero(degrees == degree)
        table = involutions(degree)
        logs = log_probabilities(torch.from_numpy(scores[rows]).float(), degree).numpy()
        real = truth[rows][:, :degree, :degree]
        best = logs.argmax(1)
        agree = (table.reshape(len(table), -1) @ (real * 2 - 1).reshape(len(rows), -1).T).T
        at = agree.argmax(1)
        mine = logs[np.arange(len(rows)), at]
        out["degree"][rows] = degree
        out["true"][rows] = real.sum((1, 2)) / 2
        out["made"][rows] = table[best].sum((1, 2)) / 2
        out["right"][rows] = (table[best] * real).sum((1, 2)) / 2
        out["probability"][rows] = np.exp(logs[np.arange(len(rows)), best])
        out["rank"][rows] = (logs > mine[:, None] + 1e-9).sum(1)
        out["loss"][rows] = -mine
    return Verdict(**out)


def calibration_error(probability: Array, correct: Array, bins: int = 15) -> float:
    """Expected calibration error: mean |stated - seen| over equal-width bins of probability."""
    if not len(probability):
        return 0.0
    which = np.minimum((probability * bins).astype(int), bins - 1)
    count = np.bincount(which, minlength=bins)
    gap = np.abs(np.bincount(which, probability, bins) - np.bincount(which, correct, bins))
    return float(gap.sum() / count.sum())
