"""How good scores of pairs are, from the exact probabilities of all involutions of a junction."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from involute.engine.involution import MAX_LISTED_DEGREE, pair_matrix
from involute.engine.values import PlanarGraph

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

    @staticmethod
    def joined(parts: Sequence[Verdict]) -> Verdict:
        names = Verdict.__dataclass_fields__
        return Verdict(**{n: np.concatenate([getattr(p, n) for p in parts]) for n in names})

    @property
    def correct(self) -> Array:
        return self.rank == 0

    @property
    def errors(self) -> Array:
        """Pairs missed and pairs wrongly made, at each junction."""
        return self.true + self.made - 2 * self.right

    def summary(self, keep: Array | None = None) -> dict[str, float]:
        """Rates over the junctions of `keep` (J,) bool, or over all."""
        keep = np.ones(len(self.degree), bool) if keep is None else keep
        true, made, right = (int(v[keep].sum()) for v in (self.true, self.made, self.right))
        some = bool(keep.any())
        return {
            "junctions": int(keep.sum()),
            "pairs_right": right / max(true, 1),
            "pairs_wrong": 1 - right / max(made, 1),
            "junctions_right": float(self.correct[keep].mean()) if some else 0.0,
            "made_per_true": made / max(true, 1),
            "top2": float((self.rank[keep] < 2).mean()) if some else 0.0,
            "calibration_error": calibration_error(self.probability[keep], self.correct[keep]),
            "doubt_removes": self.removed_by_doubt(0.1, keep),
            "loss": float(self.loss[keep].mean()) if some else 0.0,
        }

    def removed_by_doubt(self, share: float, keep: Array) -> float:
        """Share of all errors at the most doubtful `share` of the junctions."""
        worst = np.argsort(self.probability[keep], kind="stable")
        errors = self.errors[keep][worst]
        return float(errors[: round(share * len(errors))].sum() / max(errors.sum(), 1))


def judge(scores: Array, mask: Array, truth: Array) -> Verdict:
    """Decide every junction by the most probable involution and compare with the truth.

    Args:
        scores, truth: (J, D, D) symmetric; mask: (J, D), filled from the left.
    """
    degrees = mask.sum(1).astype(int)
    out = {name: np.zeros(len(scores)) for name in Verdict.__dataclass_fields__}
    for degree in np.unique(degrees):
        rows = np.flatnonzero(degrees == degree)
        a, b = np.triu_indices(degree, 1)
        ways = pair_matrix(degree).astype(np.float64)
        total = scores[rows][:, a, b] @ ways.T
        real = truth[rows][:, a, b]
        each = np.arange(len(rows))
        at = (real @ (2 * ways - 1).T - ways.sum(1)).argmax(1)
        best = total.argmax(1)
        top = total[each, best]
        norm = top + np.log(np.exp(total - top[:, None]).sum(1))
        out["degree"][rows] = degree
        out["true"][rows] = real.sum(1)
        out["made"][rows] = ways[best].sum(1)
        out["right"][rows] = (ways[best] * real).sum(1)
        out["probability"][rows] = np.exp(top - norm)
        out["rank"][rows] = (total > total[each, at][:, None] + 1e-9).sum(1)
        out["loss"][rows] = norm - total[each, at]
    return Verdict(**out)


def tables(
    graph: PlanarGraph, pairs: Array, pair_score: Array, partner: Array
) -> tuple[Array, Array, Array]:
    """Scores, mask and truth of a drawing for `judge`, junctions in the graph's order.

    Junctions with more half-branches than involutions are listed for are left out.
    """
    order, starts = graph.halves_at
    kept = graph.junctions[graph.degrees[graph.junctions] <= MAX_LISTED_DEGREE]
    degree = graph.degrees[kept]
    slots = int(degree.max(initial=3))
    row = np.full(len(graph.vertices), -1)
    row[kept] = np.arange(len(kept))
    place = np.empty(len(order), int)
    place[order] = np.arange(len(order)) - starts[graph.half_vertex[order]]
    at = row[graph.half_vertex[pairs[:, 0]]]
    known = at >= 0
    at, (a, b) = at[known], pairs[known].T
    scores = np.zeros((len(kept), slots, slots))
    truth = np.zeros_like(scores)
    scores[at, place[a], place[b]] = scores[at, place[b], place[a]] = pair_score[known]
    truth[at, place[a], place[b]] = truth[at, place[b], place[a]] = partner[a] == b
    return scores, (np.arange(slots) < degree[:, None]).astype(np.float32), truth


def calibration_error(probability: Array, correct: Array, bins: int = 15) -> float:
    """Expected calibration error: mean |stated - seen| over equal-width bins of probability."""
    if not len(probability):
        return 0.0
    which = np.minimum((probability * bins).astype(int), bins - 1)
    count = np.bincount(which, minlength=bins)
    gap = np.abs(np.bincount(which, probability, bins) - np.bincount(which, correct, bins))
    return float(gap.sum() / count.sum())
