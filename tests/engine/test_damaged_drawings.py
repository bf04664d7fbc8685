"""What is read from a file is a sound drawing, or one sentence says what is wrong and where."""

from __future__ import annotations

import base64
import copy
import json
import re
import secrets
import zlib
from pathlib import Path

import cv2
import numpy as np
import pytest
from involute.engine import Drawing, InvoluteError, Settings, vectorize
from involute.engine.formats import drawing_json, svg
from involute.engine.soundness import UnsoundError, check_drawing

MUTATIONS = 150  # of each format in a run
HEAD = '<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 100 100">'


def traced(**settings) -> Drawing:
    """Lines with junctions, a circle, a solid and regions."""
    page = np.full((120, 160, 3), 255, np.uint8)
    for y in (20, 50, 80):
        cv2.line(page, (10, y), (120, y + 15), (0, 0, 0), 2, cv2.LINE_AA)
    for x in (30, 70):
        cv2.line(page, (x, 8), (x + 10, 108), (0, 0, 160), 2, cv2.LINE_AA)
    cv2.circle(page, (135, 30), 12, (0, 0, 0), 2, cv2.LINE_AA)
    cv2.rectangle(page, (125, 80), (150, 108), (0, 0, 0), -1)
    return vectorize(page, Settings(provider="classical", router="geometric", **settings))


@pytest.fixture(scope="module")
def drawing() -> Drawing:
    return traced(regions=True)


@pytest.fixture(scope="module")
def document(drawing) -> dict:
    return json.loads(drawing_json.dumps(drawing))


def array(box: dict) -> np.ndarray:
    raw = zlib.decompress(base64.b64decode(box["data"]))
    return np.frombuffer(raw, box["dtype"]).reshape(box["shape"]).copy()


def changed(document: dict, place: str, change) -> dict:
    """The document with the array (or value) at a place replaced by what a function makes of it."""
    document = copy.deepcopy(document)
    *path, last = place.split(".")
    inner = document
    for name in path:
        inner = inner[name]
    old = inner[last]
    if isinstance(old, dict) and "dtype" in old:
        inner[last] = drawing_json._packed(np.asarray(change(array(old))))
    else:
        inner[last] = change(old)
    return document


def put(index, value):
    def change(values):
        values[index] = value
        return values

    return change


# --- JSON ------------------------------------------------------------------------------------


@pytest.mark.parametrize("settings", [{}, {"regions": True}, {"curve": "bezier"}])
def test_what_the_engine_makes_is_sound(settings):
    drawing = traced(**settings)
    check_drawing(drawing)
    assert drawing.junctions
    assert len(drawing.fills) == 1
    check_drawing(drawing_json.read(drawing_json.dumps(drawing)))
    check_drawing(svg.read(svg.dumps(drawing)))


@pytest.mark.parametrize(
    ("place", "change", "says"),
    [
        ("strokes.points", put((1, 0), np.nan), "the points of stroke 0 are not in range"),
        ("strokes.points", put((1, 0), np.inf), "the points of stroke 0 are not in range"),
        ("strokes.points", lambda p: 0 * p + 9, "stroke 0 has no length: all its points are one"),
        ("strokes.widths", put(0, -1), "the widths of stroke 0 are not above zero"),
        ("strokes.opacity", put(0, 1.5), "the opacity of stroke 0"),
        ("strokes.offsets", lambda o: o[::-1], "the points of the strokes don't fit together"),
        ("strokes.branches", put(0, 10_000), "the branches of stroke 0 name what is not there"),
        ("strokes.branches", lambda b: np.roll(b, 1), "stroke"),
        ("strokes.color", lambda c: c[:, :2], "the table 'color' of the strokes"),
        ("strokes.closed", lambda c: c[:-1], "don't fit together"),
        ("graph.ends", put((0, 0), 9999), "the ends of the branches name what is not there"),
        ("graph.ends", lambda e: e[::-1].copy(), "a branch does not end at its vertex"),
        ("graph.vertices", put((0, 0), np.nan), "the vertices are not in range"),
        ("graph.offsets", put(1, 1), "a branch has fewer than two points"),
        ("graph.widths", lambda w: w[:-1], "the widths of the branches are not a table"),
        ("routing.partner", lambda p: np.roll(p, 1), "no involution"),
        ("routing.partner", put(0, -1), "the partners of the half-branches name"),
        ("routing.pairs", put((0, 0), 9999), "the pairs of half-branches name"),
        ("routing.pair_score", put(0, np.nan), "the scores of the pairs are no numbers"),
        ("routing.locked", lambda _: np.zeros(99, bool), "which junctions are locked"),
        ("routing.alternatives", lambda a: a[:-1], "don't fit the junctions"),
        ("routing.alternatives", lambda a: [[[[], 2.0]], *a[1:]], "junction 0 has a probability"),
        ("routing.alternatives", lambda a: [[[[[0, 0]], 0.5]], *a[1:]], "junction 0 joins what"),
        ("routing.alternatives", lambda a: [[], *a[1:]], "junction 0 has no alternatives"),
        ("fills.points", put((0, 1), np.nan), "the outline of fill 0 are not in range"),
        ("fills.ring_offsets", put(-1, 9), "the fills don't fit together"),
        ("region_colors", lambda c: c[:-1], "the colors of its regions don't fit"),
        ("size", lambda _: [0, 100], "its size is not that of a page"),
        ("size", lambda _: [1.5, 100], "its size is no number of pixels"),
        ("size", lambda _: [True, 100], "its size is no number of pixels"),
        ("scale", lambda _: -1, "its scale can't be"),
        ("seconds", lambda _: {"scan": "long"}, "its seconds are no numbers"),
        ("settings", lambda s: s | {"smoothing": 9}, "Setting smoothing must lie between"),
        ("settings", lambda s: s | {"inks": "no"}, "Setting inks must be true or false"),
        ("version", lambda _: "1", "its version is no number"),
        ("version", lambda _: True, "its version is no number"),
        ("format", lambda _: "words", "it does not say that it is one"),
        ("graph", lambda _: None, "not laid out as one"),
        ("routing", lambda r: r | {"more": 5}, "not laid out as one"),
    ],
)
def test_the_sentence_says_what_is_wrong_and_where(document, place, change, says):
    text = json.dumps(changed(document, place, change))
    with pytest.raises(InvoluteError, match=re.escape(says)) as raised:
        drawing_json.read(text.replace("NaN", "null"), "page.json")
    sentence = str(raised.value)
    assert sentence.startswith("page.json ")
    assert sentence.endswith(".")
    assert "\n" not in sentence


def test_branches_without_widths_are_refused(document):
    """Regions, and which junctions are doubtful, are measured in pen widths."""
    lacking = copy.deepcopy(document)
    lacking["graph"]["widths"] = None
    with pytest.raises(InvoluteError, match="the branches have no widths"):
        drawing_json.read(json.dumps(lacking))


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("[" * 200_000, "damaged"),
        ('{"a":' * 100_000, "damaged"),
        ("null", "does not say"),
        ("", "line 1, column 1"),
        ('{"format":"involute drawing","version":NaN}', "NaN stands in it"),
        ('{"format":"involute drawing","version":1e400}', "its version is no number"),
        ('{"format":"involute drawing","version":' + "9" * 10_000 + "}", "damaged"),
        ('{"format":"involute drawing","version":2}', "written by a newer Involute"),
        ('{"format":"involute drawing","version":1}', "not laid out"),
    ],
)
def test_odd_json_is_refused(text, says):
    with pytest.raises(InvoluteError, match=says):
        drawing_json.read(text)


def test_nothing_is_unpacked_that_is_larger_than_it_says(document):
    bomb = base64.b64encode(zlib.compress(b"\0" * 2**26, 9)).decode()
    for shape, says in (
        ([10, 2], "not the size that it says"),
        ([2**40, 2], "larger than those of any page"),
        ([-1, 2], "an unknown kind"),
        ([2**24, 2], "not the size that it says"),
    ):
        box = {"dtype": "float32", "shape": shape, "data": bomb}
        with pytest.raises(InvoluteError, match=says):
            drawing_json.read(
                json.dumps(changed(document, "graph", lambda g, b=box: g | {"points": b}))
            )


# --- SVG -------------------------------------------------------------------------------------


def test_regions_of_an_svg_are_those_of_its_closed_lines(tmp_path):
    ring = '<path d="M20,20 L60,20 60,60 20,60 20,20" data-closed="1" stroke-width="2"/>'
    (tmp_path / "a.svg").write_text(f"{HEAD}{ring}</svg>")
    drawing = Drawing.load(tmp_path / "a.svg")
    assert len(drawing.regions) == 1
    np.testing.assert_allclose(drawing.graph.widths, 2)


@pytest.mark.parametrize(
    ("body", "says"),
    [
        ('<path d="L9,9"/>', "does not begin with a point"),
        ('<path d="C1,1 2,2 3,3"/>', "does not begin with a point"),
        ('<path d="M0,0"/>', "stroke 0 is not one line"),
        ('<path d="M4,4 L4,4"/>', "stroke 0 has no length"),
        ('<path d="M4,4 L4,4 4,4" data-closed="1"/>', "stroke 0 has no length"),
        ('<path d="M4,4 C4,4 4,4 4,4"/>', "stroke 0 has no length"),
        ('<path d="M0,0 L"/>', "does not begin with a point"),
        ('<path d="M0 L9,9"/>', "can't be read"),
        ('<path d="m0,0 l9,9"/>', "other commands"),
        ('<path d="Mnan,nan Linf,inf"/>', "out of range"),
        ('<path d="M1e39,0 L9,9"/>', "out of range"),
        ('<path d="M0,0 L9,9" data-widths=""/>', "not as many as points"),
        ('<path d="M0,0 L9,9" data-widths="1 2 3"/>', "not as many as points"),
        ('<path d="M0,0 L9,9" data-widths="nan"/>', "out of range"),
        ('<path d="M0,0 L9,9" stroke-width="inf"/>', "out of range"),
        ('<path d="M0,0 L9,9" stroke-width="-5"/>', "not above zero"),
        ('<path d="M0,0 L9,9" data-opacity="2000"/>', "the opacity of stroke 0"),
        ('<path d="M0,0 L9,9" stroke="#zzzzzz"/>', "can't be read"),
        ('<path data-fill="0" d=""/>', "other commands"),
        ("<g>", "mismatched tag"),
    ],
)
def test_damaged_svg_is_refused(body, says, tmp_path):
    (tmp_path / "a.svg").write_text(f"{HEAD}{body}</svg>")
    with pytest.raises(InvoluteError, match=says):
        Drawing.load(tmp_path / "a.svg")


@pytest.mark.parametrize("box", ["nan nan", "inf inf", "-5 -5", "0 0", "1e30 1e30", "5", "x y"])
def test_pages_without_a_size_are_refused(box):
    with pytest.raises(InvoluteError, match="isn't an SVG"):
        svg.read(f'{HEAD.replace("100 100", box)}<path d="M0,0 L9,9"/></svg>')


def test_entities_are_not_expanded():
    laughs = "".join(f"<!ENTITY a{k} '{f'&a{k - 1};' * 10}'>" for k in range(1, 12))
    for text in (f"<!DOCTYPE svg [<!ENTITY a0 'ha'>{laughs}]>{HEAD}&a11;</svg>",):
        with pytest.raises(InvoluteError, match="declares entities"):
            svg.read(text)


# --- anything --------------------------------------------------------------------------------


def use(drawing: Drawing, folder: Path) -> None:
    """Everything that is done with drawings."""
    for junction in drawing.junctions[:3]:
        for way in junction.alternatives[:2]:
            drawing.reroute(junction.index, way.pairs)
    assert drawing.regions is not None
    drawing.accept_above(0.9).ask_again()
    for suffix in (".svg", ".json", ".png"):
        drawing.save(folder / f"out{suffix}")


def damaged(text: str, random: np.random.Generator) -> str:
    """The text with something wrong in it."""
    at, length = int(random.integers(len(text))), int(random.integers(1, 40))
    numbers = list(re.finditer(r"-?\d+(\.\d+)?", text))
    number = numbers[int(random.integers(len(numbers)))]
    odd = str(random.choice(["nan", "-1", "1e400", "", "9" * 30, "0", "1 1", "null", "M", "Z"]))
    return [
        lambda: text[:at],
        lambda: text[:at] + text[at + length :],
        lambda: text[:at] + text[at : at + length] + text[at:],
        lambda: text[:at] + str(random.choice(list('<>"{}[],& \0'))) + text[at:],
        lambda: text[: number.start()] + odd + text[number.end() :],
    ][int(random.integers(5))]()


@pytest.mark.parametrize("form", ["json", "svg"])
def test_a_damaged_drawing_is_refused_or_sound(form, drawing, document, tmp_path):
    seed = secrets.randbits(32)
    random = np.random.default_rng(seed)
    text = drawing_json.dumps(drawing) if form == "json" else svg.dumps(drawing)
    read = drawing_json.read if form == "json" else svg.read
    rooms = ("graph", "routing", "strokes", "fills")
    tables = [(a, b) for a in rooms for b, box in document[a].items() if isinstance(box, dict)]
    places = [f"{a}.{b}" for a, b in tables]
    for count in range(MUTATIONS):
        if form == "json" and count % 2:
            place = str(random.choice(places))
            text_now = json.dumps(changed(document, place, lambda v: shuffled(v, random)))
        else:
            text_now = damaged(text, random)
        try:
            again = read(text_now)
        except InvoluteError:
            continue
        try:
            check_drawing(again)
            use(again, tmp_path)
        except (InvoluteError, UnsoundError) as error:
            raise AssertionError(f"seed {seed}, {count}: {error}") from error
        except Exception as error:
            raise AssertionError(f"seed {seed}, {count}") from error


def shuffled(values: np.ndarray, random: np.random.Generator) -> np.ndarray:
    """An array with something wrong in it."""
    if values is None or not values.size:
        return np.zeros((1, 2), np.float32)
    flat = values.reshape(-1)
    at = int(random.integers(len(flat)))
    how = int(random.integers(4))
    if how == 0:
        return random.permutation(values)
    if how == 1:
        return values[: int(random.integers(len(values)))]
    flat[at] = random.choice([0, 1, 2, 7, 100]) if values.dtype.kind != "f" else -flat[at] * 3
    return values.T if how == 2 and values.ndim > 1 else values


# --- the schema ------------------------------------------------------------------------------


def test_the_schema_has_what_is_written(document):
    """Every key of a drawing stands in docs/drawing.schema.json, with its kind of numbers."""
    path = Path(__file__).resolve().parents[2] / "docs" / "drawing.schema.json"
    schema = json.loads(path.read_text("utf-8"))
    assert document.keys() <= schema["properties"].keys()
    assert set(schema["required"]) <= document.keys()
    assert schema["properties"]["version"]["const"] == drawing_json.VERSION
    for room in ("graph", "routing", "strokes", "fills"):
        known = schema["properties"][room]
        assert set(known["required"]) <= document[room].keys() <= set(known["properties"])
        for name, box in document[room].items():
            table = known["properties"][name]
            table = table.get("anyOf", [table])[0]
            if isinstance(box, dict):
                assert table["properties"]["dtype"]["const"] == box["dtype"], name
                assert len(table["properties"]["shape"]["prefixItems"]) == len(box["shape"]), name
