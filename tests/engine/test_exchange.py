"""What other programs get: each format opened by a reader that nobody here wrote.

Strokes, their order, widths to 5 %, layers and frames are held against the drawing.
"""

from __future__ import annotations

import json
import os
import re
import shutil
import subprocess
import sys
from dataclasses import replace
from importlib.resources import files
from itertools import pairwise
from pathlib import Path
from xml.etree import ElementTree

import cv2
import ezdxf
import jsonschema
import numpy as np
import otmcp.pli
import pypdf
import pytest
import svgelements
from hypothesis import example, given, settings
from hypothesis import strategies as st
from involute.engine import Drawing, InvoluteError, Settings, Stroke
from involute.engine.formats import FORMATS, format_of, plot_paths, svg
from involute.engine.formats import lottie as lottie_file
from involute.engine.formats.flatten import outline, widths_along
from involute.engine.formats.pen_shape import pen_shape
from involute.engine.ink.ink_names import ink_layers
from rlottie_python import LottieAnimation
from shapely import LineString, Point, Polygon, unary_union
from shapely.ops import polygonize

STEP = np.array([30, 10], np.float32)
BLACK, RED = (16, 16, 20), (200, 30, 30)
LABEL = "{http://www.inkscape.org/namespaces/inkscape}label"


def stroke(points, widths, color=BLACK, closed=False, handles=None, opacity=1.0) -> Stroke:
    points = np.array(points, np.float32)
    count = len(points)
    return Stroke(
        points,
        np.broadcast_to(np.array(widths, np.float32), count).copy(),
        np.full(count, opacity, np.float32),
        closed,
        color,
        np.zeros(1, np.int32),
        None if handles is None else np.array(handles, np.float32),
    )


def page(*strokes: Stroke, fills=(), size=(400, 300), dpi=254.0) -> Drawing:
    """A drawing of these strokes; at 254 dpi ten pixels are a millimetre."""
    numbered = tuple(
        replace(s, branches=np.array([2 * i], np.int32)) for i, s in enumerate(strokes)
    )
    return Drawing(*svg._unconnected(numbered), numbered, fills, size, Settings(), dpi=dpi)


def wave(color=BLACK, y=60.0, thin=2.0, thick=9.0) -> Stroke:
    """A line that swells from thin to thick and back."""
    x = np.linspace(40, 360, 41)
    widths = thin + (thick - thin) * np.sin(np.linspace(0, np.pi, 41))
    return stroke(np.stack([x, y + 12 * np.sin(x / 50)], 1), widths, color)


def ring(center=(200, 200), radius=50.0, width=4.0, color=BLACK) -> Stroke:
    angle = np.linspace(0, 2 * np.pi, 33)[:-1]
    points = np.array(center) + radius * np.stack([np.cos(angle), np.sin(angle)], 1)
    return stroke(points, width, color, closed=True)


def curve(color=RED) -> Stroke:
    points = np.array([[40, 250], [150, 150], [260, 250]], np.float32)
    handles = np.stack([points - STEP, points + STEP], 1)
    handles[0, 0], handles[-1, 1] = points[0], points[-1]
    return stroke(points, [3, 6, 3], color, handles=handles)


SQUARE = np.array([[300, 200], [360, 200], [360, 260], [300, 260]], np.float32)
HOLE = ((SQUARE - [330, 230]) / 3 + [330, 230])[::-1].astype(np.float32)


def everything() -> Drawing:
    """Two inks, in turns; lines, a ring and a curve; a solid area with a hole."""
    return page(wave(), wave(RED, 120), ring(), curve(), fills=((SQUARE, HOLE),))


def true_shape(line, radii) -> Polygon:
    """What a round pen covers: the hulls of its discs from point to point."""
    discs = [Point(*p).buffer(r, 32) for p, r in zip(line, radii, strict=True)]
    return unary_union([unary_union(pair).convex_hull for pair in pairwise(discs)] or discs)


def filled(rings) -> Polygon:
    """The area of rings by the nonzero rule."""
    closed = [np.vstack([r, r[:1]]) for r in rings]
    faces = polygonize(unary_union([LineString(r) for r in closed]))
    return unary_union([f for f in faces if _winding(f.representative_point(), closed)])


def _winding(point: Point, rings) -> int:
    total = 0.0
    for r in rings:
        x, y = (r - [point.x, point.y]).T
        total += ((np.diff(np.arctan2(y, x)) + np.pi) % (2 * np.pi) - np.pi).sum()
    return round(total / (2 * np.pi))


def width_across(shape, line, at: int) -> float:
    """How wide a shape is across a line at one of its points."""
    way = line[at + 1] - line[at - 1]
    across = 40 * np.array([-way[1], way[0]]) / np.hypot(*way)
    cut = shape.intersection(LineString([line[at] - across, line[at] + across]))
    parts = getattr(cut, "geoms", [cut])
    return min(parts, key=lambda part: part.distance(Point(line[at]))).length


def ends_of(path: svgelements.Path) -> np.ndarray:
    """Where the segments of a path end."""
    return np.array([[segment.end.x, segment.end.y] for segment in path.segments()])


# --- names -----------------------------------------------------------------------------------


def test_the_longer_ending_names_the_format():
    assert format_of("a/Page.PLOT.svg").name == "plot.svg"
    assert format_of("a/plot.svg").name == "svg"
    assert format_of(".svg") is None


def test_the_manual_has_a_row_for_every_format():
    manual = Path(__file__).resolve().parents[2] / "docs" / "manual" / "formats.md"
    rows = [line for line in manual.read_text("utf-8").splitlines() if line.startswith("| `.")]
    assert {re.match(r"\| `([^`]+)`", row)[1] for row in rows} == {
        *(f.suffix for f in FORMATS),
        ".blend",
    }


# --- SVG with shapes -------------------------------------------------------------------------


def test_outlines_have_the_true_widths(tmp_path):
    drawing = everything()
    drawing.save(tmp_path / "page.outline.svg")
    document = svgelements.SVG.parse(str(tmp_path / "page.outline.svg"), reify=True)
    shapes = [p for p in document.elements() if "data-outline" in getattr(p, "values", {})]
    assert len(shapes) == len(drawing.strokes)
    by_number = {int(p.values["data-outline"]): p for p in shapes}
    for number in (0, 1):
        one, path = drawing.strokes[number], by_number[number]
        shape = filled([ends_of(svgelements.Path(part)) for part in path.as_subpaths()])
        for at in range(2, 39, 4):
            measured = width_across(shape, one.points.astype(float), at)
            assert measured == pytest.approx(one.widths[at], rel=0.05)
        assert path.fill.hex == "#" + bytes(one.color).hex()


def test_outlines_are_in_a_layer_per_ink_and_lines_in_a_hidden_one(tmp_path):
    drawing = everything()
    drawing.save(tmp_path / "page.outline.svg")
    root = ElementTree.parse(tmp_path / "page.outline.svg").getroot()
    layers = {g.get(LABEL): g for g in root if g.get(LABEL)}
    assert list(layers) == ["Solids", "Black", "Red", "Center Lines"]
    assert len(layers["Black"]) == len(layers["Red"]) == 2
    assert "display:none" in layers["Center Lines"].get("style")


def test_outlines_are_read_back_as_strokes(tmp_path):
    drawing = everything()
    drawing.save(tmp_path / "page.outline.svg")
    again = Drawing.load(tmp_path / "page.outline.svg")
    assert len(again.strokes) == 4
    for one, other in zip(drawing.strokes, again.strokes, strict=True):
        np.testing.assert_allclose(one.points, other.points, atol=2e-3)
        np.testing.assert_allclose(one.widths, other.widths, atol=2e-3)
        assert (one.color, one.closed) == (other.color, other.closed)
    assert len(again.fills) == 1


@settings(max_examples=60, deadline=None)
@example(points=[(0, 0), (0, 0)], widths=[1.0, 2.0], closed=False)
@example(points=[(4, 6), (0, 0), (0, 7)], widths=[1.0, 4.0, 1.0], closed=False)
@given(
    points=st.lists(st.tuples(*[st.integers(0, 100)] * 2), min_size=1, max_size=8, unique=True),
    widths=st.lists(st.floats(0.5, 12), min_size=8, max_size=8),
    closed=st.booleans(),
)
def test_the_shape_of_any_stroke_is_what_its_pen_covers(points, widths, closed):
    if not closed and len(points) < 2:
        return
    one = stroke(points, widths[: len(points)], closed=closed)
    line = np.vstack([one.points, one.points[:1]]) if closed else one.points
    radii = np.append(one.widths, one.widths[:1]) / 2 if closed else one.widths / 2
    true, ours = true_shape(line, radii), filled(pen_shape(one))
    # Beside a taper the sides run a little inside of the hull of the two discs.
    slack = 0.1 + float(np.ptp(radii)) / 2
    assert ours.difference(true.buffer(slack)).area < 0.5
    assert true.buffer(-slack).difference(ours).area < 0.5 + 0.02 * true.area


# --- SVG for plotters ------------------------------------------------------------------------


def plotted(path: Path) -> dict[str, list[np.ndarray]]:
    """The lines of each layer, as svgelements reads them, in mm."""
    found: dict[str, list[np.ndarray]] = {}
    document = svgelements.SVG.parse(str(path), ppi=25.4, reify=True)
    for group in document.select(lambda e: isinstance(e, svgelements.Group)):
        name = group.values.get("attributes", {}).get(LABEL)
        for one in group.select(lambda e: isinstance(e, svgelements.Path)):
            if name:
                found.setdefault(name, []).append(ends_of(one))
    return found


def test_plots_are_in_millimetres_with_a_layer_per_pen(tmp_path):
    everything().save(tmp_path / "page.plot.svg")
    document = svgelements.SVG.parse(str(tmp_path / "page.plot.svg"), ppi=25.4)
    assert (document.width, document.height) == pytest.approx((40.0, 30.0))
    layers = plotted(tmp_path / "page.plot.svg")
    assert list(layers) == ["1 Black", "2 Red", "3 Solids"]
    (line,) = [line for line in layers["1 Black"] if not np.allclose(line[0], line[-1])]
    np.testing.assert_allclose(sorted(line[[0, -1], 0]), [4.0, 36.0], atol=0.01)


def test_a_line_drawn_twice_is_plotted_once(tmp_path):
    twice = wave()
    again = stroke(twice.points[::-1][10:] + np.float32(0.3), 3)
    crossing = stroke([[200, 10], [210, 110]], 3)
    page(twice, again, crossing).save(tmp_path / "page.plot.svg")
    lines = plotted(tmp_path / "page.plot.svg")["1 Black"]
    drawn = sum(plot_paths.arc(line)[-1] for line in lines)
    once = sum(plot_paths.arc(s.points)[-1] for s in (twice, crossing)) / 10
    assert drawn == pytest.approx(once, rel=0.01)
    assert len(lines) == 2


def test_lines_that_meet_are_plotted_in_one_go(tmp_path):
    pieces = [stroke([[x, 50], [x + 40, 50]], 3) for x in (200, 40, 160, 80, 120)]
    page(*pieces).save(tmp_path / "page.plot.svg")
    (line,) = plotted(tmp_path / "page.plot.svg")["1 Black"]
    assert np.ptp(line[:, 0]) == pytest.approx(20.0, abs=0.01)


def test_solid_areas_are_hatched_and_their_holes_are_not(tmp_path):
    everything().save(tmp_path / "page.plot.svg")
    lines = plotted(tmp_path / "page.plot.svg")["3 Solids"]
    ink = unary_union([LineString(line) for line in lines]).buffer(0.25)
    area = Polygon(SQUARE / 10, [HOLE / 10])
    assert area.difference(ink).area < 0.02 * area.area
    assert ink.intersection(Polygon(HOLE / 10).buffer(-0.3)).area == 0


@settings(max_examples=40, deadline=None)
@given(
    st.lists(
        st.lists(st.tuples(*[st.integers(0, 60)] * 2), min_size=2, max_size=5, unique=True),
        max_size=12,
    )
)
def test_plots_lose_nothing_and_invent_nothing(lines):
    lines = [np.array(line, np.float64) for line in lines]
    found = plot_paths.joined(plot_paths.without_doubles(lines, 2.0), 2.0)
    found = plot_paths.in_short_order(found)
    before = unary_union([LineString(line) for line in lines])
    after = unary_union([LineString(line) for line in found])
    assert before.difference(after.buffer(1.0)).length < 0.5
    assert after.difference(before.buffer(1.0)).length < 0.5


def test_the_short_order_is_short():
    rng = np.random.default_rng(3)
    lines = [rng.random(2) * 1000 + rng.random((2, 2)) * 20 for _ in range(300)]

    def up(ordered) -> float:
        return sum(np.hypot(*(b[0] - a[-1])) for a, b in pairwise(ordered))

    found = plot_paths.in_short_order(lines)
    assert len(found) == 300
    assert up(found) < up(lines) / 8


# --- DXF -------------------------------------------------------------------------------------


def dxf(drawing: Drawing, folder: Path):
    drawing.save(folder / "page.dxf")
    document = ezdxf.readfile(folder / "page.dxf")
    auditor = document.audit()
    assert (auditor.errors, auditor.fixes) == ([], [])
    return document


def test_dxf_has_lines_with_widths_in_layers_by_ink(tmp_path):
    drawing = everything()
    document = dxf(drawing, tmp_path)
    assert document.units == ezdxf.units.MM
    inks = {"Black": BLACK, "Red": RED}
    for name, color in inks.items():
        assert document.layers.get(name).rgb == color
    lines = document.modelspace().query("LWPOLYLINE")
    assert [line.dxf.layer for line in lines] == ["Black", "Black", "Red"]
    wavy = lines.first
    rows = np.array(list(wavy.get_points("xyse")))
    one = drawing.strokes[0]
    np.testing.assert_allclose(rows[:, :2], one.points * (0.1, -0.1) + (0, 30), atol=1e-4)
    np.testing.assert_allclose(rows[:, 2], one.widths / 10, rtol=0.05)
    np.testing.assert_allclose(rows[:-1, 3], one.widths[1:] / 10, rtol=0.05)
    assert [line.closed for line in lines] == [False, True, False]


def test_curves_are_splines_in_dxf(tmp_path):
    bent = curve()
    closed = replace(bent, closed=True)
    document = dxf(page(bent, closed), tmp_path)
    for spline, one in zip(document.modelspace().query("SPLINE"), (bent, closed), strict=True):
        line = outline(one)  # 16 points for each segment
        tool = spline.construction_tool()
        points = tool.points(np.linspace(0, len(line) // 16, len(line)))
        found = np.array([(p.x, p.y) for p in points])
        np.testing.assert_allclose(found, line * (0.1, -0.1) + (0, 30), atol=1e-3)
        assert spline.dxf.lineweight == 40  # hundredths of a mm, the mean width


def test_solid_areas_are_hatches_with_holes_in_dxf(tmp_path):
    (hatch,) = dxf(everything(), tmp_path).modelspace().query("HATCH")
    outer, hole = (Polygon([v[:2] for v in path.vertices]) for path in hatch.paths)
    assert outer.area == pytest.approx(36.0, rel=1e-3)
    assert hole.area == pytest.approx(4.0, rel=1e-3)
    assert hatch.dxf.solid_fill == 1


def test_the_same_drawing_gives_the_same_dxf(tmp_path):
    for name in ("a.dxf", "b.dxf"):
        everything().save(tmp_path / name)
    assert (tmp_path / "a.dxf").read_bytes() == (tmp_path / "b.dxf").read_bytes()


def test_every_process_gives_the_same_dxf(tmp_path):
    everything().save(tmp_path / "page.json")
    code = "import sys, involute.engine as e; e.Drawing.load(sys.argv[1]).save(sys.argv[2])"
    for seed in ("1", "4"):  # with these, sets of DXF's own words have unlike orders
        subprocess.run(
            [sys.executable, "-c", code, tmp_path / "page.json", tmp_path / f"{seed}.dxf"],
            env={**os.environ, "PYTHONHASHSEED": seed},
            check=True,
        )
    assert (tmp_path / "1.dxf").read_bytes() == (tmp_path / "4.dxf").read_bytes()


# --- PDF -------------------------------------------------------------------------------------


def poppler(tool: str, *arguments: str | Path) -> str:
    """What one of Poppler's tools prints."""
    if shutil.which(tool) is None:
        pytest.skip(f"needs {tool} (apt install poppler-utils)")
    done = subprocess.run([tool, *map(str, arguments)], capture_output=True, text=True, check=True)
    assert done.stderr == ""
    return done.stdout


def test_pdf_is_as_large_as_the_paper_and_has_the_inks_where_they_were(tmp_path):
    everything().save(tmp_path / "page.pdf")
    info = poppler("pdfinfo", tmp_path / "page.pdf")
    width, height = map(float, re.search(r"Page size: +([\d.]+) x ([\d.]+) pts", info).groups())
    assert (width / 72 * 254, height / 72 * 254) == pytest.approx((400, 300), abs=0.1)
    poppler("pdftoppm", "-r", 254 * 4, "-png", "-singlefile", tmp_path / "page.pdf", tmp_path / "p")
    picture = cv2.imread(str(tmp_path / "p.png"))
    assert picture.shape[:2] == pytest.approx((1200, 1600), abs=1)
    for one in everything().strokes[:2]:
        for at in range(2, 39, 4):
            x, y = (one.points[at] * 4).astype(int)
            assert np.abs(picture[y, x, ::-1].astype(int) - one.color).max() < 6
            column = picture[y - 40 : y + 40, x, 0] < 128  # blue: both inks lack it
            step = one.points[at + 1] - one.points[at - 1]
            across = column.sum() / 4 * abs(step[0]) / np.hypot(*step)
            assert across == pytest.approx(one.widths[at], rel=0.05, abs=0.15)
    assert picture[230 * 4, 330 * 4].min() == 255  # the hole of the solid area
    assert picture[205 * 4, 305 * 4].max() == 0


def test_pdf_has_a_layer_per_ink(tmp_path):
    everything().save(tmp_path / "page.pdf")
    root = pypdf.PdfReader(tmp_path / "page.pdf").trailer["/Root"]
    groups = [group.get_object() for group in root["/OCProperties"]["/OCGs"]]
    assert [group["/Name"] for group in groups] == ["Solids", "Black", "Red"]


def test_even_strokes_are_lines_in_pdf(tmp_path):
    bent = replace(curve(), widths=np.full(3, 4, np.float32))
    page(bent, ring()).save(tmp_path / "page.pdf")
    text = pypdf.PdfReader(tmp_path / "page.pdf").pages[0].get_contents().get_data().decode()
    assert re.search(r"4 w .* c S$", text, re.MULTILINE)
    assert re.search(r"4 w .* l s$", text, re.MULTILINE)


def test_a_sequence_is_the_pages_of_a_pdf(tmp_path):
    kind = format_of("shot.pdf")
    frames = [(1, page(wave())), (4, page(ring(), wave(RED)))]
    kind.write_sequence("shot", iter(frames), tmp_path / "shot.pdf")
    assert "Pages:           2" in poppler("pdfinfo", tmp_path / "shot.pdf")


# --- Lottie ----------------------------------------------------------------------------------


def lottie(path: Path) -> dict:
    """A Lottie file that follows the schema of the Lottie Animation Community."""
    document = json.loads(path.read_text("utf-8"))
    schema = json.loads((files("lottie_specs") / "data/lottie.schema.json").read_text("utf-8"))
    check = jsonschema.validators.validator_for(schema)(schema)
    assert [error.message for error in check.iter_errors(document)] == []
    return document


def played(path: Path, frame: int) -> np.ndarray:
    """(H, W) how much ink rlottie shows at a frame, 0 to 255."""
    player = LottieAnimation.from_data(path.read_text("utf-8"))
    width, height = player.lottie_animation_get_size()
    pixels = player.lottie_animation_render(frame)
    return np.frombuffer(pixels, np.uint8).reshape(height, width, 4)[..., 3]


def test_a_drawing_draws_itself_in_lottie(tmp_path):
    drawing = everything()
    drawing.save(tmp_path / "page.lottie.json")
    document = lottie(tmp_path / "page.lottie.json")
    assert [layer["nm"] for layer in document["layers"]] == ["Black", "Red", "Solids"]
    shares = [int((played(tmp_path / "page.lottie.json", k) > 128).sum()) for k in (1, 48, 94, 110)]
    assert shares == sorted(set(shares))  # more and more of it
    whole = played(tmp_path / "page.lottie.json", 110)
    for one in drawing.strokes[:2]:
        for at in range(2, 39, 4):
            x, y = (one.points[at]).astype(int)
            column = whole[y - 10 : y + 10, x].sum() / 255
            step = one.points[at + 1] - one.points[at - 1]
            across = column * abs(step[0]) / np.hypot(*step)
            assert across == pytest.approx(one.widths[at], rel=0.08, abs=0.3)


@given(st.lists(st.floats(0.5, 20), min_size=2, max_size=12), st.booleans())
def test_the_pieces_of_a_stroke_have_its_widths(widths, closed):
    one = stroke([[10 * k, k % 3] for k in range(len(widths))], widths, closed=closed)
    line = LineString(outline(one))
    pieces = lottie_file._pieces(one)
    assert sum(plot_paths.arc(piece)[-1] for piece, _ in pieces) == pytest.approx(line.length)
    for (before, _), (after, _) in pairwise(pieces):
        np.testing.assert_allclose(before[-1], after[0])
    if not closed:
        for piece, width in pieces:
            true = np.interp(piece[:, 0], one.points[:, 0], one.widths)
            np.testing.assert_allclose(width, true, rtol=0.04)


def test_a_sequence_plays_in_lottie(tmp_path):
    place = tmp_path / "shot.lottie.json"
    frames = [(101, page(wave())), (104, page(ring())), (106, page())]
    format_of(place).write_sequence("shot", iter(frames), place)
    document = lottie(place)
    assert (document["ip"], document["op"]) == (0, 6)
    spans = [(layer["ip"], layer["op"]) for layer in document["layers"]]
    assert spans == [(0, 3), (3, 5)]
    # rlottie shows a layer one frame longer than the specification says.
    first, third, fifth, last = (played(place, k) for k in (0, 2, 4, 6))
    assert np.array_equal(first, third)
    x, y = frames[0][1].strokes[0].points[20].astype(int)
    assert first[y, x] == 255
    assert fifth[y, x] == last.max() == 0
    assert fifth[200, 250] > 128


# --- OpenToonz and Tahoma2D ------------------------------------------------------------------


UNIT = 53.33333 / 254  # of a level, per pixel of our page


def quadratics(read) -> np.ndarray:
    """Points along a stroke as the reader of opentoonz-mcp gives it: px, and width in px."""
    rows = np.array(read.points)
    t = np.linspace(0, 1, 9)[:, None, None]
    a, b, c = rows[:-2:2], rows[1:-1:2], rows[2::2]
    curve = ((1 - t) ** 2 * a + 2 * t * (1 - t) * b + t**2 * c).transpose(1, 0, 2).reshape(-1, 3)
    return curve / UNIT * (1, -1, 2) + (200, 150, 0)


def test_a_level_has_lines_with_thickness(tmp_path):
    drawing = everything()
    drawing.save(tmp_path / "page.pli")
    _, found = otmcp.pli.read(str(tmp_path / "page.pli"))
    borders = found[4:]
    assert [read.loop for read in found] == [False, True, False, False, True, True]
    in_order = [drawing.strokes[k] for k in (0, 2, 1, 3)]  # ink by ink
    for read, one in zip(found, in_order, strict=False):
        points = quadratics(read)
        line = LineString(outline(one))
        assert max(line.distance(Point(p[:2])) for p in points) < 0.4, one.color
        assert LineString(points[:, :2]).length == pytest.approx(line.length, rel=0.01)
        places = [line.project(Point(p[:2]), normalized=True) for p in points]
        at = np.concatenate([[0], np.cumsum(np.hypot(*np.diff(outline(one), axis=0).T))])
        true = np.interp(places, at / at[-1], widths_along(one))
        np.testing.assert_allclose(points[1:-1, 2], true[1:-1], rtol=0.05)
    for read, ring_of in zip(borders, drawing.fills[0], strict=True):
        area = Polygon(quadratics(read)[:, :2]).area
        assert area == pytest.approx(Polygon(ring_of).area, rel=0.01)


def test_a_level_has_a_style_per_ink_and_the_frames_of_a_sequence(tmp_path):
    place = tmp_path / "shot.pli"
    frames = [(3, page(wave(), wave(RED, 99))), (7, page(wave(RED))), (8, page())]
    format_of(place).write_sequence("shot", iter(frames), place)
    data, found = otmcp.pli.read(str(place))
    assert [read.frame for read in found] == [3, 3, 7]
    assert data.count(b"Black") == data.count(b"Red") == 1
    channels = b"".join(bytes((1, value)) for value in (*RED, 255))
    assert data.count(channels) == 1


# --- inks ------------------------------------------------------------------------------------


def test_inks_of_one_name_have_layers_of_their_own():
    layers = ink_layers([wave(), wave(RED), wave(RED), wave((220, 10, 60))])
    assert [(ink.name, ink.numbers) for ink in layers] == [
        ("Red", (1, 2)),
        ("Black", (0,)),
        ("Red 2", (3,)),
    ]


def test_what_lacks_its_library_says_which(monkeypatch, tmp_path):
    monkeypatch.setattr("involute.engine.formats.find_spec", lambda name: None)
    for kind in FORMATS:
        if kind.needs:
            with pytest.raises(InvoluteError, match=f"needs the library {kind.needs[0]}"):
                everything().save(tmp_path / f"page{kind.suffix}")
