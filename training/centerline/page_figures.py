"""How good a predicted page is: pooled counts, so that pages can be added up."""

from __future__ import annotations

from typing import Any

import cv2
import numpy as np
from scipy.spatial import cKDTree

from ...synthesis.line_art import Array
from .targets import MAX_HALF_WIDTH

_LEVELS = 64  # of a map's values, in which they are counted
_JUNCTION = 12  # px around a junction in which a line that passes it is told from one that ends


def ridge_points(line: Array, level: float = 0.4) -> Array:
    """Sub-pixel crest of a ridge map, (N, 2) px: maxima across the line, fitted by a parabola."""
    smooth = np.pad(line.astype(np.float32), 1)
    center = smooth[1:-1, 1:-1]
    points = []
    for axis in (0, 1):
        before = smooth[:-2, 1:-1] if axis == 0 else smooth[1:-1, :-2]
        after = smooth[2:, 1:-1] if axis == 0 else smooth[1:-1, 2:]
        peak = (center > level) & (center >= before) & (center > after)
        # Across a line the fall is steep; along it a tiny wave is no crest.
        bend = before + after - 2 * center
        peak &= bend < -0.25 * center
        y, x = np.nonzero(peak)
        shift = 0.5 * (before - after)[y, x] / bend[y, x]
        p = np.stack([x + 0.5, y + 0.5], 1)
        p[:, 1 - axis] += np.clip(shift, -0.5, 0.5)
        points.append(p)
    return np.concatenate(points)


def peaks(heat: Array, level: float = 0.4) -> Array:
    """(N, 2) px: maxima of a heatmap above a level, at most one within 2 px; equal ones merge."""
    heat = heat.astype(np.float32)
    top = (heat >= cv2.dilate(heat, np.ones((5, 5), np.uint8))) & (heat > level)
    _, _, _, centers = cv2.connectedComponentsWithStats(top.astype(np.uint8))
    return centers[1:] + 0.5


def _matched(found: Array, truth: Array, within: float) -> tuple[int, int]:
    """How many of found are near a truth, and the other way round."""
    if not len(found) or not len(truth):
        return 0, 0
    to_truth = cKDTree(truth).query(found)[0] < within
    to_found = cKDTree(found).query(truth)[0] < within
    return int(to_truth.sum()), int(to_found.sum())


def page_figures(seen: Array, truth: Array, level: float = 0.4) -> dict[str, Any]:
    """Counts and sums of one page, which can be added up; seen, truth: (C, H, W) in [0, 1],
    channels as unet.HEADS, the first four at least; level: above which a crest counts as a line."""
    mine, true = ridge_points(seen[0], level), ridge_points(truth[0], 0.6)
    out: dict[str, Any] = {"mine": len(mine), "true": len(true)}
    out["mine_ok"], out["true_ok"] = _matched(mine, true, 1.5)
    out["distance"] = out["distance_n"] = 0.0
    if len(mine) and len(true):
        there, back = cKDTree(true).query(mine)[0], cKDTree(mine).query(true)[0]
        out["distance"] = float(np.minimum(there, 10).sum() + np.minimum(back, 10).sum())
        out["distance_n"] = len(there) + len(back)
    for channel, name in ((1, "junction"), (2, "endpoint")):
        a, b = peaks(seen[channel]), peaks(truth[channel], 0.6)
        out[f"{name}_mine"], out[f"{name}_true"] = len(a), len(b)
        out[f"{name}_mine_ok"], out[f"{name}_true_ok"] = _matched(a, b, 2.0)
    ridge = truth[0] > 0.6
    out["half_error"] = float(np.abs(seen[3] - truth[3])[ridge].sum() * MAX_HALF_WIDTH)
    out["half_n"] = int(ridge.sum())
    return out | _further_figures(seen, truth, ridge, level) | _ends_told(seen, truth)


def _further_figures(seen: Array, truth: Array, ridge: Array, level: float) -> dict[str, float]:
    """Counts of the maps that only newer networks have: doubled, apart, clean."""
    if len(seen) < 8:
        return {}
    mine, true = ridge_points(seen[7], level), ridge_points(truth[7], 0.6)
    out: dict[str, float] = {"clean_mine": len(mine), "clean_true": len(true)}
    out["clean_mine_ok"], out["clean_true_ok"] = _matched(mine, true, 1.5)
    known = ridge & (np.abs(truth[5] - 0.5) > 0.2)
    two, found = truth[5] > 0.5, seen[5] > 0.5
    out["doubled_mine"], out["doubled_true"] = int((known & found).sum()), int((known & two).sum())
    out["doubled_ok"] = int((known & found & two).sum())
    error = np.abs(seen[6] - truth[6])[known & two]
    out["apart_error"] = float(error.sum() * MAX_HALF_WIDTH)
    return out


def _ends_told(seen: Array, truth: Array) -> dict[str, Any]:
    """How often each value of the map `lifted` is seen on lines that end and on lines that go on;
    everywhere, and near junctions alone, where no free end gives it away."""
    if len(seen) < 9:
        return {}
    line, lifted = truth[7] > 0.6, truth[8]
    value = np.clip(seen[8] * _LEVELS, 0, _LEVELS - 1).astype(int)
    wide = np.ones((2 * _JUNCTION + 1,) * 2, np.uint8)
    near = (cv2.dilate(truth[1], wide) > 0.5) & (cv2.dilate(truth[2], wide) < 0.5)
    out = {}
    for name, where in (("lifted", line), ("lifted_near", line & near)):
        out[f"{name}_ends"] = np.bincount(value[where & (lifted > 0.4)], minlength=_LEVELS)
        out[f"{name}_goes_on"] = np.bincount(value[where & (lifted < 0.02)], minlength=_LEVELS)
    return out


def _told_apart(higher: Array, lower: Array) -> float:
    """Area under the curve: how often one of those counted in `higher` has the larger value than
    one of `lower`; a half where there are none."""
    if not higher.sum() or not lower.sum():
        return 0.5
    below = np.cumsum(lower) - lower / 2
    return float((higher * below).sum() / (higher.sum() * lower.sum()))


def pooled(figures: list[dict[str, Any]]) -> dict[str, float]:
    """Precision, recall and mean distances over pages."""
    sums = {k: sum(f[k] for f in figures) for k in figures[0]}

    def share(part: str, whole: str) -> float:
        return round(sums[part] / max(1, sums[whole]), 4)

    figures = {
        "precision": share("mine_ok", "mine"),
        "recall": share("true_ok", "true"),
        "chamfer_px": share("distance", "distance_n"),
        "junction_precision": share("junction_mine_ok", "junction_mine"),
        "junction_recall": share("junction_true_ok", "junction_true"),
        "endpoint_precision": share("endpoint_mine_ok", "endpoint_mine"),
        "endpoint_recall": share("endpoint_true_ok", "endpoint_true"),
        "half_width_error_px": share("half_error", "half_n"),
    }
    if "clean_mine" in sums:
        figures |= {
            "clean_precision": share("clean_mine_ok", "clean_mine"),
            "clean_recall": share("clean_true_ok", "clean_true"),
            "doubled_precision": share("doubled_ok", "doubled_mine"),
            "doubled_recall": share("doubled_ok", "doubled_true"),
            "apart_error_px": share("apart_error", "doubled_true"),
        }
    if "lifted_ends" in sums:
        for name in ("lifted", "lifted_near"):
            told = _told_apart(sums[f"{name}_ends"], sums[f"{name}_goes_on"])
            figures[f"{name}_auc"] = round(told, 4)
    return figures
