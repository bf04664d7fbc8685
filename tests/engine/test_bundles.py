"""One line or two: what is asked of a rough drawing, what answers change, where they are kept."""

from __future__ import annotations

import json
from dataclasses import replace

import numpy as np
import pytest
from involute.command.cli import main
from involute.engine import Drawing, InvoluteError, Settings, vectorize
from involute.engine.decisions import carried
from involute.engine.formats import drawing_json
from involute.engine.rough.unchanged import unchanged
from involute.engine.sequence.follow import reverse
from involute.engine.soundness import check_drawing

from .test_damaged_drawings import changed, put
from .test_rough import page, sketched

ROUGH = Settings(drawing="rough")
APART = 9.0  # px between two strokes that may be one line or two


def with_a_pair(shift: float = 0.0) -> np.ndarray:
    """The sketch, and below it two upright strokes."""
    y = np.linspace(150, 250, 40)
    pair = [np.stack([np.full(40, 200 + x + shift), y], 1) for x in (0.0, APART)]
    return page([*sketched(), *pair])


@pytest.fixture(scope="module")
def rough() -> Drawing:
    return vectorize(with_a_pair(), ROUGH)


def the_pair(drawing: Drawing):
    """The question about the two upright strokes."""
    near = [np.hypot(b.position[0] - 204, b.position[1] - 200) for b in drawing.bundles]
    return drawing.bundles[int(np.argmin(near))]


def upright(drawing: Drawing) -> list:
    """The lines between them, or each its own."""
    inside = [s for s in drawing.strokes if np.ptp(s.points[:, 1]) > 60]
    return [s for s in inside if np.ptp(s.points[:, 0]) < 15 and 190 < s.points[0, 0] < 220]


def answered(drawing: Drawing, one: bool) -> Drawing:
    asked = the_pair(drawing)
    return drawing.reroute(asked.index, (asked.strokes,) if one else ())


def test_what_runs_beside_each_other_is_asked(rough):
    asked = the_pair(rough)
    assert abs(asked.position[0] - 204.5) < 4
    assert sum(way.probability for way in asked.alternatives) == pytest.approx(1)
    assert [len(way.pairs) for way in asked.alternatives] in ([0, 1], [1, 0])
    assert not asked.locked
    assert asked.index >= len(rough.graph.places)
    assert rough.asked(asked.index) is asked
    assert all(b.doubt > 0 for b in rough.bundles)


def test_the_answer_makes_one_line_or_two(rough):
    one, two = (answered(rough, joined) for joined in (True, False))
    assert len(upright(one)) == 1
    assert len(upright(two)) == 2
    (line,) = upright(one)
    assert abs(np.median(line.points[:, 0]) - 204.5) < 1.5
    for drawing, pairs in ((one, 1), (two, 0)):
        asked = the_pair(drawing)
        assert asked.locked
        assert asked.doubt == 0
        assert len(asked.pairs) == pairs
        check_drawing(drawing)
    # Either way back, and back to what was traced.
    assert len(upright(answered(one, False))) == 2
    free = one.unlock(the_pair(one).index)
    assert not the_pair(free).locked
    np.testing.assert_array_equal(free.graph.points, rough.graph.points)


def test_the_rest_of_the_page_stays(rough):
    one = answered(rough, not the_pair(rough).pairs)
    far = [s.points for s in rough.strokes if s not in upright(rough)]
    assert far
    for points in far:
        assert any(np.array_equal(points, s.points) for s in one.strokes)


@pytest.mark.parametrize("curve", ["polyline", "bezier"])
def test_lines_that_hardly_change_keep_their_strokes(rough, curve):
    """The page's typical pressure and width change with every line, and all strokes with them."""
    old = rough.restroked(replace(ROUGH, curve=curve)).strokes

    def moved(stroke, by, wider):
        handles = None if stroke.handles is None else stroke.handles + np.float32(by)
        points, widths = stroke.points + np.float32(by), stroke.widths * np.float32(wider)
        branches = stroke.branches + 2
        return replace(stroke, points=points, widths=widths, handles=handles, branches=branches)

    for before, now in zip(old, unchanged(old, [moved(s, 0.1, 1.02) for s in old]), strict=True):
        assert now.points is before.points
        assert now.widths is before.widths
        np.testing.assert_array_equal(now.branches, before.branches + 2)
    for by, wider in ((1.0, 1.0), (0.0, 1.3)):
        changed = [moved(s, by, wider) for s in old]
        assert unchanged(old, changed) == tuple(changed)
    assert unchanged(old[:1], [*old, old[0]])[-1] is old[0]
    assert unchanged((), old) == old


def test_lines_of_a_sequence_keep_direction_and_ink(rough):
    """As its frame before had them, strokes run the other way, and their ink is another shade."""
    turned = tuple(replace(reverse(s), color=(9, 9, 9)) for s in rough.strokes)
    frame = replace(rough, strokes=turned)
    told = answered(frame, not the_pair(rough).pairs)
    far = [s.points for s in frame.strokes if s not in upright(frame)]
    there = [s.points.tobytes() for s in told.strokes]
    numbers = [there.index(points.tobytes()) for points in far]
    assert numbers == sorted(numbers)
    assert {s.color for s in told.strokes} == {(9, 9, 9)}


def test_without_an_answer_nothing_changes(rough):
    again = rough.answered(rough.pencil.answers)
    np.testing.assert_array_equal(again.graph.points, rough.graph.points)
    assert again.notes == rough.notes


def test_three_strokes_are_parted_where_they_hold_least():
    y = np.linspace(120, 320, 60)
    three = [np.stack([np.full(60, 200.0 + x), y], 1) for x in (0, 3.5, 12)]
    drawing = vectorize(page([*sketched(), *three]), ROUGH)
    asked = max(drawing.bundles, key=lambda b: b.span[1] - b.span[0] if b.position[0] > 200 else 0)
    assert [len(upright(drawing.reroute(asked.index, (asked.strokes,))))] == [1]
    two = upright(drawing.reroute(asked.index, ()))
    middle = sorted(float(np.median(s.points[:, 0])) for s in two)
    assert len(middle) == 2
    assert middle[0] < 204
    assert middle[1] > 209


def test_regions_keep_their_colors():
    color = np.stack([with_a_pair()] * 3, -1)
    sides = [np.stack([x, np.full(50, 300.0)], 1) for x in [np.linspace(60, 160, 50)]]
    for (x, y), (right, low) in [((60, 300), (60, 390)), ((160, 300), (160, 390))]:
        sides.append(np.stack([np.linspace(x, right, 50), np.linspace(y, low, 50)], 1))
    sides.append(sides[0] + [0, 90])
    box = page(sides)
    color = np.minimum(color, box[..., None])
    color[304:387, 64:157] = (255, 120, 60)
    drawing = vectorize(color, replace(ROUGH, regions=True))
    told = answered(drawing, not the_pair(drawing).pairs)
    for one in (drawing, told):
        painted = (one.region_colors != 255).any(1)
        middles = [rings[0].mean(0) for rings in one.regions]
        inside = [bool(abs(x - 110) < 20 and abs(y - 345) < 20) for x, y in middles]
        assert painted.tolist() == inside
        assert any(inside)
    check_drawing(told)


def test_the_command_lists_them(rough, tmp_path, capsys):
    told = answered(rough, not the_pair(rough).pairs)
    told.save(tmp_path / "kept.json")
    assert main(["inspect", str(tmp_path / "kept.json")]) == 0
    text = capsys.readouterr().out
    assert f"bundles    {len(told.bundles)}, " in text
    row = next(r for r in text.splitlines() if r.startswith(f"{the_pair(told).index:9d}"))
    assert "lock " in row
    assert ("one line (two lines" if the_pair(told).pairs else "two lines (one line") in row


def test_locking_keeps_what_is_in_force(rough):
    asked = the_pair(rough)
    locked = rough.lock(asked.index)
    assert the_pair(locked).locked
    assert the_pair(locked).pairs == asked.pairs
    sure = rough.accept_above(0.5)
    assert sum(b.locked for b in sure.bundles) > 1


def test_lines_are_merged_and_split(rough):
    two = answered(rough, False)
    first, second = (two.strokes.index(line) for line in upright(two))
    one = two.merge([first, second])
    assert len(upright(one)) == 1
    assert the_pair(one).locked
    check_drawing(one)
    again = drawing_json.read(drawing_json.dumps(one))
    (line,) = upright(again)
    assert len(upright(again.split(again.strokes.index(line)))) == 2
    with pytest.raises(InvoluteError, match="run beside each other"):
        two.split(first)
    with pytest.raises(InvoluteError, match="There is no stroke"):
        two.merge([0, 999])


def test_a_clean_drawing_has_nothing_to_split():
    clean = vectorize(with_a_pair(), Settings(drawing="clean"))
    with pytest.raises(InvoluteError, match="what its lines were made of"):
        clean.split(0)
    assert clean.bundles == ()


def test_a_bundle_takes_no_other_answer(rough):
    with pytest.raises(InvoluteError, match="one line or two"):
        rough.reroute(the_pair(rough).index, [(0, 99)])
    with pytest.raises(InvoluteError, match="There is no junction"):
        rough.lock(len(rough.graph.places) + len(rough.bundles))


@pytest.mark.parametrize("one", [True, False])
def test_a_file_keeps_the_answers(rough, tmp_path, one):
    told = answered(rough, one)
    told.save(tmp_path / "kept.json")
    read = Drawing.load(tmp_path / "kept.json")
    assert [(b.strokes, b.pairs, b.locked) for b in read.bundles] == [
        (b.strokes, b.pairs, b.locked) for b in told.bundles
    ]
    assert len(upright(answered(read, not one))) == (1 if not one else 2)


def test_files_of_before_open_and_ask_nothing(rough):
    document = json.loads(drawing_json.dumps(rough))
    for name in ("beside", "answers"):
        document["pencil"].pop(name, None)
    old = drawing_json.read(json.dumps(document))
    assert old.pencil.beside is None
    assert old.bundles == ()
    assert old.pencil_of(0) == rough.pencil_of(0)
    assert drawing_json.read(drawing_json.dumps(old)).bundles == ()


@pytest.mark.parametrize("one", [True, False])
def test_the_page_traced_again_keeps_the_answers(rough, one):
    told = answered(rough, one)
    same, lost = carried(told, vectorize(with_a_pair(), replace(ROUGH, smoothing=0.9)))
    assert lost == 0
    assert len(upright(same)) == (1 if one else 2)
    assert the_pair(same).locked
    moved, lost = carried(told, vectorize(with_a_pair(0.4), ROUGH))
    assert lost == 0
    assert len(upright(moved)) == (1 if one else 2)


def test_answers_without_a_place_are_counted(rough):
    told = answered(rough, not the_pair(rough).pairs)
    assert carried(told, vectorize(page(sketched()), ROUGH)).lost == 1
    assert carried(told, vectorize(with_a_pair(), replace(ROUGH, drawing="clean"))).lost == 1


def test_junction_decisions_survive_an_answer(rough):
    junction = max(rough.junctions, key=lambda j: -np.hypot(j.position[0] - 60, j.position[1] - 60))
    decided = rough.reroute(junction.index, junction.alternatives[-1].pairs)
    told = answered(decided, not the_pair(rough).pairs)
    kept = [p for p in told.junctions if np.hypot(*np.subtract(p.position, junction.position)) < 1]
    assert [p.locked for p in kept] == [True]


@pytest.mark.parametrize(
    ("place", "change", "says"),
    [
        ("beside.graph.points", put((0, 0), np.nan), "the points of the branches are not in range"),
        ("beside.partner", lambda p: np.roll(p, 1), "no involution"),
        ("beside.strokes", put((0, 0), 9999), "what runs beside each other name"),
        ("beside.spans", put((0, 0), np.inf), "what runs beside each other are not in range"),
        ("beside.probability", put(0, 1.5), "what runs beside each other"),
        ("beside.right", lambda r: r[:-1], "what runs beside each other are not a table"),
        ("answers.one", lambda o: o[:-1], "the answers are not a table"),
        ("answers.strokes", lambda s: s[:, ::-1], "an answer is not about two pencil strokes"),
        ("answers.strokes", put((0, 1), 9999), "the answers name what is not there"),
    ],
)
def test_what_is_damaged_is_said(rough, place, change, says):
    document = json.loads(drawing_json.dumps(answered(rough, True)))
    with pytest.raises(InvoluteError, match=says):
        drawing_json.read(json.dumps(changed(document, f"pencil.{place}", change)))
