"""Drawings survive the way to disk and back."""

from __future__ import annotations

import json
import re
import sys
from dataclasses import fields
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from involute.engine import Drawing, InvoluteError, Settings, Stroke
from involute.engine.formats import drawing_json, png, svg
from involute.engine.formats.whole_file import whole_file, write_bytes
from involute.engine.values import Alternative, PlanarGraph, Routing


def star(arms: int = 4, size: tuple[int, int] = (200, 100)) -> Drawing:
    """`arms` lines that meet in one junction, opposite ones joined; and one closed fill."""
    middle = np.array([100.0, 50.0], np.float32)
    angle = np.linspace(0, 2 * np.pi, arms, endpoint=False)
    tips = (middle + 40 * np.stack([np.cos(angle), np.sin(angle)], 1)).astype(np.float32)
    graph = PlanarGraph(
        vertices=np.concatenate([middle[None], tips]),
        points=np.stack([np.broadcast_to(middle, tips.shape), tips], 1).reshape(-1, 2),
        offsets=np.arange(0, 2 * arms + 1, 2, dtype=np.int32),
        ends=np.stack([np.zeros(arms), np.arange(1, arms + 1)], 1).astype(np.int32),
        widths=np.linspace(2, 5, 2 * arms).astype(np.float32),
    )
    partner = np.arange(2 * arms, dtype=np.int32)
    pairs = tuple((2 * i, 2 * (i + arms // 2)) for i in range(arms // 2))
    for a, b in pairs:
        partner[a], partner[b] = b, a
    ways = (Alternative(pairs, 0.7), Alternative((), 0.3))
    routing = Routing(
        partner=partner,
        pairs=np.array(pairs, np.int32),
        pair_score=np.linspace(1, 2, len(pairs)).astype(np.float32),
        alternatives=(ways,),
        locked=np.array([False]),
    )
    strokes = tuple(
        Stroke(
            points=np.stack([tips[a >> 1], middle, tips[b >> 1]]),
            widths=np.array([2, 3.25, 2.5], np.float32),
            opacity=np.array([1, 0.5, 0.875], np.float32),
            closed=i == 0,
            color=(255, 16 * i, 3),
            branches=np.array([a ^ 1, b], np.int32),
        )
        for i, (a, b) in enumerate(pairs)
    )
    square = np.array([[10, 10], [30, 10], [30, 30], [10, 30]], np.float32)
    fills = ((square, (square + 20) / 2),)
    return Drawing(graph, routing, strokes, fills, size, Settings(smoothing=0.5), {"scan": 0.25})


def curved(closed: bool) -> Drawing:
    drawing = star()
    points = np.array([[10, 20], [50, 60], [90, 20]], np.float32)
    handles = np.stack([points - [7, 5], points - [-7, 5]], 1).astype(np.float32)
    if not closed:
        handles[0, 0], handles[-1, 1] = points[0], points[-1]
    stroke = Stroke(
        points, np.ones(3, np.float32), np.ones(3, np.float32), closed, (0, 0, 0),
        np.array([0], np.int32), handles,
    )  # fmt: skip
    graph = svg._unconnected((stroke,))
    return Drawing(*graph, (stroke,), (), drawing.size, drawing.settings)


def assert_same_strokes(a: Drawing, b: Drawing, tolerance: float) -> None:
    assert len(a.strokes) == len(b.strokes)
    for left, right in zip(a.strokes, b.strokes, strict=True):
        assert left.closed == right.closed
        assert left.color == right.color
        for name in ("points", "widths", "opacity", "handles"):
            one, other = getattr(left, name), getattr(right, name)
            assert (one is None) == (other is None), name
            if one is not None:
                np.testing.assert_allclose(one, other, atol=tolerance, rtol=0, err_msg=name)


def assert_identical(a: Drawing, b: Drawing) -> None:
    for part in ("graph", "routing"):
        for field in fields(getattr(a, part)):
            one, other = (getattr(getattr(d, part), field.name) for d in (a, b))
            if isinstance(one, np.ndarray):
                assert one.dtype == other.dtype
                np.testing.assert_array_equal(one, other, err_msg=field.name)
            else:
                assert one == other, field.name
    assert_same_strokes(a, b, 0)
    for left, right in zip(a.strokes, b.strokes, strict=True):
        np.testing.assert_array_equal(left.branches, right.branches)
    assert (a.size, a.settings, dict(a.seconds)) == (b.size, b.settings, dict(b.seconds))
    assert [len(f) for f in a.fills] == [len(f) for f in b.fills]
    for one, other in zip(a.fills, b.fills, strict=True):
        for ring, twin in zip(one, other, strict=True):
            np.testing.assert_array_equal(ring, twin)


@pytest.mark.parametrize("make", [star, lambda: curved(True), lambda: curved(False)])
def test_json_keeps_everything(make, tmp_path):
    drawing = make()
    drawing.save(tmp_path / "page.json")
    assert_identical(drawing, Drawing.load(tmp_path / "page.json"))


@pytest.mark.parametrize("make", [star, lambda: curved(True), lambda: curved(False)])
def test_svg_gives_the_same_strokes(make, tmp_path):
    drawing = make()
    drawing.save(tmp_path / "page.svg")
    again = Drawing.load(tmp_path / "page.svg")
    assert_same_strokes(drawing, again, 1e-3)
    assert again.size == drawing.size
    for one, other in zip(drawing.fills, again.fills, strict=True):
        for ring, twin in zip(one, other, strict=True):
            np.testing.assert_allclose(ring, twin, atol=1e-3)


def test_svg_read_back_is_a_whole_drawing(tmp_path):
    star().save(tmp_path / "a.svg")
    Drawing.load(tmp_path / "a.svg").save(tmp_path / "b.json")
    again = Drawing.load(tmp_path / "b.json")
    again.save(tmp_path / "c.svg")
    assert (tmp_path / "a.svg").read_text() == (tmp_path / "c.svg").read_text()
    assert again.junctions == ()


def test_svg_keeps_the_contract():
    text = svg.dumps(star())
    assert 'viewBox="0 0 200 100"' in text
    strokes = re.findall(r"<path data-stroke[^>]*>", text)
    assert [int(i) for i in re.findall(r'data-stroke="(\d+)"', text)] == list(range(len(strokes)))
    for path in strokes:
        assert 'fill="none"' in path
        assert re.fullmatch(r"[MLC\d., -]+", re.search(r' d="([^"]*)"', path)[1])
    assert float(re.search(r'stroke-width="([^"]*)"', text)[1]) == pytest.approx(2.583, abs=1e-3)
    assert text.index("data-fill") < text.index("data-stroke")


@pytest.mark.parametrize("suffix", [".json", ".svg"])
def test_a_blank_drawing_survives(suffix, tmp_path):
    routing = Routing(
        np.zeros(0, np.int32), np.zeros((0, 2), np.int32), np.zeros(0, np.float32), (),
        np.zeros(0, bool),
    )  # fmt: skip
    blank = Drawing(PlanarGraph.empty(), routing, (), (), (64, 32), Settings())
    blank.save(tmp_path / f"blank{suffix}")
    again = Drawing.load(tmp_path / f"blank{suffix}")
    assert again.strokes == ()
    assert again.size == (64, 32)


@given(
    points=st.lists(
        st.tuples(*[st.floats(-50, 20_000, width=32)] * 2), min_size=2, max_size=30, unique=True
    ),
    width=st.floats(0.0009765625, 500, width=32),
    closed=st.booleans(),
)
def test_any_stroke_survives_svg(points, width, closed):
    line = np.array(points, np.float32)
    n = len(line)
    stroke = Stroke(
        line, np.full(n, width, np.float32), np.ones(n, np.float32), closed, (1, 2, 3),
        np.array([0], np.int32),
    )  # fmt: skip
    base = star()
    drawing = Drawing(base.graph, base.routing, (stroke,), (), (20_000, 20_000), base.settings)
    # float32 itself is only good to 1/1000 px at 20,000 px.
    assert_same_strokes(drawing, svg.read(svg.dumps(drawing)), 2e-3)


def test_preview_shows_every_stroke_and_the_junction(tmp_path):
    drawing = star(6)
    picture = png.render(drawing)
    assert picture.shape == (100, 200, 3)
    for stroke in drawing.strokes:
        x, y = (stroke.points[0] * 0.5 + stroke.points[1] * 0.5).astype(int)
        assert picture[y, x].min() < 128
    colors = {tuple(picture[y, x]) for x, y in [(20, 12), (100, 50), (1, 1)]}
    assert len(colors) == 3
    drawing.save(tmp_path / "page.png")
    assert (tmp_path / "page.png").read_bytes().startswith(b"\x89PNG")


def test_a_preview_of_a_huge_page_is_drawn_smaller():
    assert max(png.render(star(size=(20_000, 10_000))).shape) == 4096


@pytest.mark.parametrize(
    ("name", "content", "says"),
    [
        ("a.json", "{}", "isn't a drawing"),
        ("a.json", "[1, 2]", "isn't a drawing"),
        ("a.json", "not json", "isn't a drawing"),
        ("a.svg", "<svg", "isn't an SVG"),
        ("a.svg", '<svg xmlns="http://www.w3.org/2000/svg"/>', "isn't an SVG"),
        (
            "a.svg",
            '<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 9 9">'
            '<path d="M0 0a1 1 0 0 0 2 2"/></svg>',
            "isn't an SVG",
        ),
        ("a.png", "", "holds no drawing"),
    ],
)
def test_what_is_no_drawing_is_refused(name, content, says, tmp_path):
    (tmp_path / name).write_text(content)
    with pytest.raises(InvoluteError, match=says):
        Drawing.load(tmp_path / name)


def test_a_missing_file_is_named(tmp_path):
    with pytest.raises(InvoluteError, match=r"no file .*gone\.json"):
        Drawing.load(tmp_path / "gone.json")


def test_a_newer_version_is_refused():
    document = json.loads(drawing_json.dumps(star()))
    document["version"] += 1
    with pytest.raises(InvoluteError, match="newer Involute"):
        drawing_json.read(json.dumps(document))


def test_damaged_arrays_are_refused():
    document = json.loads(drawing_json.dumps(star()))
    for change in (
        lambda d: d["graph"]["points"].update(data="AAAA"),
        lambda d: d["graph"]["points"].update(shape=[1, 2]),
        lambda d: d["routing"].update(partner=d["graph"]["offsets"]),
        lambda d: d.pop("strokes"),
    ):
        copy = json.loads(json.dumps(document))
        change(copy)
        with pytest.raises(InvoluteError, match="damaged"):
            drawing_json.read(json.dumps(copy))


def test_an_unknown_suffix_is_refused(tmp_path):
    with pytest.raises(InvoluteError, match=r"\.svg, \.json, \.png.* or \."):
        star().save(tmp_path / "page.doc")


def test_a_missing_folder_is_said(tmp_path):
    with pytest.raises(InvoluteError, match="folder doesn't exist"):
        star().save(tmp_path / "nowhere" / "page.svg")


def test_a_failed_write_leaves_the_old_file(tmp_path):
    place = tmp_path / "page.svg"
    place.write_text("old")
    drawing = star()
    broken = Drawing(drawing.graph, drawing.routing, (None,), (), drawing.size, drawing.settings)
    with pytest.raises(AttributeError):
        broken.save(place)
    assert place.read_text() == "old"
    assert list(tmp_path.iterdir()) == [place]


@pytest.mark.skipif(sys.platform != "linux", reason="/dev/full is Linux")
def test_a_full_disk_is_said(tmp_path):
    with pytest.raises(InvoluteError, match="disk is full"), whole_file(tmp_path / "x.svg"):
        write_bytes(b"x", Path("/dev/full"))
    assert list(tmp_path.iterdir()) == []
