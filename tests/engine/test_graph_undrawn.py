"""What nobody drew goes; what was drawn stays."""

from __future__ import annotations

import cv2
import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st
from involute.engine import Settings
from involute.engine.centerline import provider_for
from involute.engine.graph import Evidence, run_passes
from involute.engine.graph.removal.undrawn import FEATURES, features, probability, remove_undrawn
from involute.engine.graph.topology import lengths
from involute.engine.scan import read_scan
from involute.engine.values import LineMaps, PlanarGraph, Scan
from involute.synthesis.media import MEDIA, draw, sample

SETTINGS = Settings()
SIZE = 320


def seen(lines: list[np.ndarray], pen: float = 3.0) -> Evidence:
    """What the network sees of polylines in even ink."""
    fine = np.zeros((SIZE * 4, SIZE * 4), np.uint8)
    for line in lines:
        fixed = np.rint((np.asarray(line, float) * 4 - 0.5) * 16).astype(np.int32)
        cv2.polylines(fine, [fixed], False, 255, round(4 * pen), cv2.LINE_8, 4)
    ink = cv2.resize(fine, (SIZE, SIZE), interpolation=cv2.INTER_AREA).astype(np.float32) / 255
    scan = Scan(ink, None, 1.0, (SIZE, SIZE), pen)
    return network_sees(scan)


def network_sees(scan: Scan) -> Evidence:
    return Evidence.of(scan, provider_for(SETTINGS)(scan, lambda fraction: None))


def all_lines(page: Evidence) -> PlanarGraph:
    """What looks like a line, drawn or not."""
    return run_passes(page, SETTINGS, until="undrawn")


CLEAN = [
    [(20, 40), (300, 60)], [(60, 20), (80, 300)], [(30, 250), (290, 120)],
    [(200, 90), (210, 280)], [(240, 200), (280, 200)], [(40, 290), (52, 296)],
]  # fmt: skip


def test_a_clean_drawing_loses_nothing():
    page = seen([np.array(line, float) for line in CLEAN])
    graph = all_lines(page)
    assert remove_undrawn(graph, page, SETTINGS) is graph


def test_crumbs_of_charcoal_go_and_its_lines_stay():
    """Lines that meet nowhere: every branch beyond one a line is false."""
    t = np.linspace(0, 1, 60)[:, None]
    lines = [np.hstack([20 + 280 * t, y + 12 * np.sin(5 * t + y)]) for y in range(40, 300, 60)]
    before = after = 0
    for seed in range(3):
        ink, _ = draw(
            np.random.default_rng(seed), sample(lines, SIZE), MEDIA["charcoal"], 7.0, SIZE
        )
        scan = read_scan(((1 - ink) * 255).astype(np.uint8), SETTINGS)
        page = network_sees(scan)
        graph = all_lines(page)
        left = remove_undrawn(graph, page, SETTINGS)
        before, after = before + graph.branch_count, after + left.branch_count
        drawn = np.concatenate(lines) / scan.scale
        away = np.hypot(*np.moveaxis(drawn[:, None] - left.points, -1, 0)).min(1)
        assert (away < 3).mean() > 0.97
    assert after <= 0.75 * before


def test_without_the_maps_of_a_network_all_stays():
    page = seen([np.array(CLEAN[0], float)])
    graph = all_lines(page)
    lines_only = Evidence(LineMaps(page.maps.centerline), page.pen_width)
    assert remove_undrawn(graph, lines_only, SETTINGS) is graph
    empty = PlanarGraph.empty()
    assert remove_undrawn(empty, page, SETTINGS) is empty


@settings(max_examples=10, deadline=None)
@given(st.integers(0, 2**32 - 1))
def test_every_branch_of_any_maps_has_a_probability(seed: int):
    rng = np.random.default_rng(seed)
    noise = [
        cv2.GaussianBlur(rng.random((90, 110)).astype(np.float32), (0, 0), 1.5) for _ in range(5)
    ]
    maps = LineMaps(*((n - n.min()) / np.ptp(n) for n in noise))
    page = Evidence(maps, 2.0)
    graph = all_lines(page)
    rows = features(graph, page)
    assert rows.shape == (graph.branch_count, FEATURES)
    assert np.isfinite(rows).all()
    stated = probability(rows)
    assert ((stated >= 0) & (stated <= 1)).all()
    left = remove_undrawn(graph, page, SETTINGS)
    assert lengths(left).sum() <= lengths(graph).sum() + 1e-3


def test_stipple_stays():
    rng = np.random.default_rng(5)
    places = [
        np.array([40 + 24 * i, 40 + 24 * j]) + rng.uniform(-4, 4, 2)
        for i in range(8)
        for j in range(8)
    ]
    tick = np.array([0.7, 0.2])
    dots = [np.stack([place - tick, place + tick]) for place in places]
    frame = np.array([[15, 15], [305, 15], [305, 305], [15, 305], [15, 15]], float)
    page = seen([frame, *dots])
    graph = all_lines(page)
    loose = (graph.degrees[graph.ends] == 1).all(1).sum()
    assert loose >= 0.95 * len(dots)
    assert remove_undrawn(graph, page, SETTINGS).branch_count >= graph.branch_count - 1


def test_the_wide_stems_of_lettering_stay():
    """The network has only seen pages of one pen; of a title above a drawing nothing may go."""
    hatch = [np.array([[30, y], [290, y + 6]], float) for y in range(120, 300, 14)]
    stems = [np.array([[x, 30], [x, 80]], float) for x in (60, 110, 160)]
    serifs = [np.array([[x - 9, 80], [x + 9, 80]], float) for x in (60, 110, 160)]
    fine = np.zeros((SIZE * 4, SIZE * 4), np.uint8)
    for lines, wide in ((hatch, 8), (serifs, 8), (stems, 28)):
        for line in lines:
            cv2.polylines(fine, [np.rint(line * 64).astype(np.int32)], False, 255, wide, 8, 4)
    paper = 255 - cv2.resize(fine, (SIZE, SIZE), interpolation=cv2.INTER_AREA)
    scan = read_scan(paper, SETTINGS)
    page = network_sees(scan)
    left = remove_undrawn(all_lines(page), page, SETTINGS)
    for stem in stems:
        middle = stem.mean(0) / scan.scale
        assert np.hypot(*(left.points - middle).T).min() < 2
