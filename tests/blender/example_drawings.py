"""Small drawings made without any picture, by the engine of the installed extension."""

from __future__ import annotations

from collections.abc import Callable
from types import ModuleType

import numpy as np

Part = Callable[[str], ModuleType]


def planar_graph(part: Part, vertices, branches):
    """A graph from vertices and (start, end, inner points) triples."""
    values = part("engine.values")
    vertices = np.asarray(vertices, np.float32)
    lines = [
        np.concatenate([vertices[a : a + 1], np.reshape(inner, (-1, 2)), vertices[b : b + 1]])
        for a, b, inner in branches
    ]
    count = sum(map(len, lines))
    return values.PlanarGraph(
        vertices=vertices,
        points=np.concatenate(lines).astype(np.float32),
        offsets=np.concatenate([[0], np.cumsum([len(line) for line in lines])]).astype(np.int32),
        ends=np.array([(a, b) for a, b, _ in branches], np.int32),
        widths=np.full(count, 3.0, np.float32),
        strength=np.full(count, 0.9, np.float32),
    )


def draw(part: Part, graph, size=(400, 300), **settings):
    """The drawing that the engine makes of a graph."""
    chosen = part("engine").Settings(router="geometric", **settings)
    routing = part("engine.routing").route(graph, chosen)
    scan = part("engine.values").Scan(np.zeros((4, 4), np.float32), None, 1.0, size, 3.0)
    return part("engine.drawing").Drawing.from_routing(graph, routing, scan, chosen)


def cross(part: Part, **settings):
    """Two wavy lines that cross once, and a circle by itself: 3 strokes, 1 junction."""
    t = np.linspace(0, 1, 12)[1:-1]
    vertices = [(200, 150), (50, 150), (350, 150), (200, 20), (200, 280), (330, 60)]

    def line(a, b, bend):
        a, b = np.array(vertices[a], float), np.array(vertices[b], float)
        normal = np.array([-(b - a)[1], (b - a)[0]]) / 100
        return a + t[:, None] * (b - a) + np.sin(2 * np.pi * t)[:, None] * normal * bend

    angles = np.linspace(0, 2 * np.pi, 40)[1:-1]
    circle = np.array(vertices[5]) + 20 * np.stack([np.cos(angles) - 1, np.sin(angles)], 1)
    branches = [(k, 0, line(k, 0, 4)) for k in (1, 2, 3, 4)] + [(5, 5, circle)]
    return draw(part, planar_graph(part, vertices, branches), **settings)


def grid(part: Part, lines: int, **settings):
    """`lines` straight lines each way: lines * lines junctions of degree 4."""
    side = np.arange(lines + 2) * 20.0 + 10
    vertices = [(x, y) for y in side for x in side]
    wide = lines + 2

    def inner(a, b):
        a, b = np.array(vertices[a]), np.array(vertices[b])
        return a + np.linspace(0, 1, 6)[1:-1, None] * (b - a)

    branches = []
    for row in range(1, wide - 1):
        for column in range(wide - 1):
            a, b = row * wide + column, row * wide + column + 1
            branches.append((a, b, inner(a, b)))
            a, b = column * wide + row, (column + 1) * wide + row
            branches.append((a, b, inner(a, b)))
    used = np.unique([k for a, b, _ in branches for k in (a, b)])
    number = {int(k): i for i, k in enumerate(used)}
    branches = [(number[a], number[b], points) for a, b, points in branches]
    size = (int(side[-1]) + 10, int(side[-1]) + 10)
    return draw(part, planar_graph(part, [vertices[k] for k in used], branches), size, **settings)


def ring_and_lines(part: Part, **settings):
    """A circle that two lines cross, a loop that hangs on one junction: closed strokes to open."""
    angles = np.deg2rad([0, 90, 180, 270])
    ring = np.array([200, 150]) + 80 * np.stack([np.cos(angles), np.sin(angles)], 1)
    tips = np.array([200, 150]) + 130 * np.stack([np.cos(angles), np.sin(angles)], 1)
    vertices = [*ring, *tips, (200, 150)]

    def arc(start, stop, centre=(200, 150), radius=80):
        turn = np.deg2rad(np.linspace(start, stop, 14)[1:-1])
        return np.array(centre) + radius * np.stack([np.cos(turn), np.sin(turn)], 1)

    def straight(a, b):
        a, b = np.array(vertices[a]), np.array(vertices[b])
        return a + np.linspace(0, 1, 5)[1:-1, None] * (b - a)

    branches = [(k, (k + 1) % 4, arc(90 * k, 90 * k + 90)) for k in range(4)]
    branches += [(k, 4 + k, straight(k, 4 + k)) for k in range(4)]
    branches += [(k, 8, straight(k, 8)) for k in range(4)]
    branches.append((4, 4, arc(180, 540, centre=(350, 150), radius=20)))
    return draw(part, planar_graph(part, vertices, branches), **settings)


def many_strokes(part: Part, count: int, points: int):
    """A drawing of separate strokes with that many points each."""
    values, drawing = part("engine.values"), part("engine.drawing")
    random = np.random.default_rng(1)
    lines = random.uniform(0, 1000, (count, points, 2)).astype(np.float32)
    full = np.ones(points, np.float32)
    strokes = tuple(
        values.Stroke(line, 2 * full, full, False, (0, 0, 0), np.array([2 * i], np.int32))
        for i, line in enumerate(lines)
    )
    empty = values.PlanarGraph.empty()
    routing = part("engine.routing").route(empty, part("engine").Settings())
    return drawing.Drawing(empty, routing, strokes, (), (1000, 1000), part("engine").Settings(), {})
