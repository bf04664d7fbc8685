"""Closed regions: every one once, with its holes, whatever else is drawn."""

from __future__ import annotations

from itertools import combinations

import numpy as np
import pytest
import shapely
from hypothesis import given
from involute.engine.fills.faces import closed_regions
from involute.engine.values import PlanarGraph
from involute.synthesis.true_graph import graph_from_strokes

from tests.engine.scribbles import scribbles


def area(ring):
    x, y = ring.astype(float).T
    return 0.5 * abs(np.dot(x, np.roll(y, -1)) - np.dot(y, np.roll(x, -1)))


def net_area(region):
    return area(region[0]) - sum(area(hole) for hole in region[1:])


def graph_of(*strokes):
    return graph_from_strokes([np.asarray(s, float) for s in strokes])[0]


def box(x, y, side):
    return [(x, y), (x + side, y), (x + side, y + side), (x, y + side), (x, y)]


def test_a_window_has_four_panes():
    regions = closed_regions(
        graph_of(box(0, 0, 100), [(50, -20), (50, 130)], [(-10, 40), (110, 40)])
    )
    assert sorted(round(net_area(r)) for r in regions) == [2000, 2000, 3000, 3000]


def test_what_stands_free_inside_is_a_hole_and_a_region():
    regions = closed_regions(graph_of(box(0, 0, 100), box(30, 30, 20), box(35, 35, 5)))
    assert [round(net_area(r)) for r in regions] == [9600, 375, 25]
    assert [len(r) for r in regions] == [2, 2, 1]


def test_lines_that_end_bound_nothing():
    assert closed_regions(graph_of([(0, 0), (50, 50)], [(0, 50), (50, 0)])) == ()
    with_tail = closed_regions(graph_of(box(0, 0, 100), [(100, 50), (60, 50), (60, 80)]))
    assert [round(net_area(r)) for r in with_tail] == [10000]
    assert closed_regions(PlanarGraph.empty()) == ()


@pytest.mark.parametrize("smallest", [0, 400, 20_000])
def test_small_regions_are_left_out(smallest):
    regions = closed_regions(graph_of(box(0, 0, 100), box(200, 0, 10)), smallest)
    assert len(regions) == sum(a > smallest for a in (10_000, 100))


def planar(graph):
    """Whether no branch crosses or touches another one but at their ends."""
    lines = shapely.linestrings(
        np.concatenate([graph.branch(b) for b in range(graph.branch_count)]).astype(float),
        indices=np.repeat(np.arange(graph.branch_count), np.diff(graph.offsets)),
    )
    a, b = shapely.STRtree(lines).query(lines, "intersects")
    a, b = a[a < b], b[a < b]
    shared = shapely.get_num_geometries(shapely.intersection(lines[a], lines[b]))
    ends = [len(np.intersect1d(graph.ends[i], graph.ends[j])) for i, j in zip(a, b, strict=True)]
    return shapely.is_simple(lines).all() and np.array_equal(shared, ends)


def slivers(graph):
    """How many pairs of branches link the same two vertices and hold nothing between them."""
    found = 0
    for i, j in combinations(range(graph.branch_count), 2):
        if sorted(graph.ends[i]) == sorted(graph.ends[j]):
            one, two = graph.branch(i), graph.branch(j)
            back = two[::-1] if graph.ends[i, 0] == graph.ends[j, 0] else two
            found += area(np.concatenate([one, back])) <= 1e-3
    return found


@given(scribbles(12))
def test_euler_counts_the_regions_and_they_do_not_overlap(scribble, drawn):
    graph, _ = scribble(drawn)
    regions = closed_regions(graph)
    parent = np.arange(len(graph.vertices))
    for a, b in graph.ends:  # groups of lines that hang together
        parent[parent == parent[a]] = parent[b]
    groups = len(set(parent.tolist()))
    # Euler: V - E + F = 1 + C, one face being the outside.
    faces = graph.branch_count - len(graph.vertices) + groups
    assert len(regions) <= faces
    if planar(graph):
        assert len(regions) == faces - slivers(graph)
    box_area = np.prod(np.ptp(graph.points, axis=0).astype(float))
    assert sum(net_area(r) for r in regions) <= box_area * 1.001 + 1
