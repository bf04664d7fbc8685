"""Scan borders, peg holes and registration marks: found, never traced, used to align."""

from __future__ import annotations

import json

import cv2
import numpy as np
import pytest
from involute.command.cli import main
from involute.engine import Settings
from involute.engine.scan import read_scan
from involute.engine.scan.registration import anchors_of, find_marks, rigid, set_aside

SIZE = (900, 700)  # width, height
PIXELS_PER_MM = 3.0
PAPER, INK = 250, 20


def page(holes="acme", *, ring=False, crosses=False, drawing=True):
    image = np.full((SIZE[1], SIZE[0]), PAPER, np.uint8)
    if drawing:
        t = np.linspace(0, 2 * np.pi, 200)
        for k in range(4):
            curve = np.stack(
                [450 + (80 + 50 * k) * np.cos(t + k), 320 + (60 + 40 * k) * np.sin(2 * t)], 1
            )
            cv2.polylines(image, [np.int32(curve * 16)], False, INK, 3, cv2.LINE_AA, 4)
    thick = 2 if ring else cv2.FILLED
    for kind, x, y in hole_places(holes):
        if kind == "round":
            cv2.circle(image, (x, y), round(3.2 * PIXELS_PER_MM), INK, thick, cv2.LINE_AA)
        else:
            half, r = round(6.35 * PIXELS_PER_MM), round(1.6 * PIXELS_PER_MM)
            turns = [(x - half + r, y, 90, 270), (x + half - r, y, -90, 90)]
            arc = [cv2.ellipse2Poly((a, b), (r, r), 0, c, d, 5) for a, b, c, d in turns]
            outline = [np.concatenate(arc)]
            if ring:
                cv2.polylines(image, outline, True, INK, 2, cv2.LINE_AA)
            else:
                cv2.fillPoly(image, outline, INK, cv2.LINE_AA)
    if crosses:
        for x, y in cross_places():
            cv2.line(image, (x - 14, y), (x + 14, y), INK, 2, cv2.LINE_AA)
            cv2.line(image, (x, y - 14), (x, y + 14), INK, 2, cv2.LINE_AA)
            cv2.circle(image, (x, y), 8, INK, 2, cv2.LINE_AA)
    return image


def hole_places(holes):
    distance = round(101.6 * PIXELS_PER_MM)
    if holes == "acme":
        return [("slot", 450 - distance, 640), ("round", 450, 640), ("slot", 450 + distance, 640)]
    if holes == "file":
        return [("round", 40, 350 - 120), ("round", 40, 350 + 120)]
    if holes == "three":
        return [("round", 450 + d, 40) for d in (-260, 0, 260)]
    return []


def cross_places():
    return [(50, 50), (850, 50), (850, 650)]


def laid(image, degrees=0.0, shift=(0, 0), lid=PAPER):
    """The page askew on the scanner, and where its points come to lie."""
    motion = cv2.getRotationMatrix2D((450, 350), degrees, 1)
    motion[:, 2] += shift
    out = cv2.warpAffine(image, motion, SIZE, flags=cv2.INTER_CUBIC, borderValue=lid)
    return out, motion


def scan_of(image, **settings):
    return read_scan(image, Settings(**settings))


def marks_of(image):
    scan = scan_of(image)
    return find_marks(scan.ink, scan.pen_width)


@pytest.mark.parametrize("ring", [False, True])
@pytest.mark.parametrize("degrees", [0, 1.5, -2])
def test_a_peg_bars_holes_are_found_to_the_pixel(ring, degrees):
    image, motion = laid(page(ring=ring), degrees)
    found = marks_of(image).anchors
    true = np.array([(x, y, 1) for _, x, y in hole_places("acme")]) @ motion.T + 0.5
    assert found.shape == (3, 2)
    assert np.abs(found - true).max() < 1.0


def test_a_file_punch_and_crosses_are_found():
    assert np.abs(marks_of(page("file")).anchors - [[40.5, 230.5], [40.5, 470.5]]).max() < 1
    found = marks_of(page("three")).anchors
    assert np.abs(found - [[450.5 + d, 40.5] for d in (-260, 0, 260)]).max() < 1
    found = marks_of(page("none", crosses=True)).anchors
    assert np.abs(found - np.array(sorted(cross_places())) - 0.5).max() < 1


def tinted(holes, tint, shadow=0.7):
    """A page of colored paper, (H, W, 3) uint8: through its holes one sees the white lid, with the
    sheet's shadow on one side."""
    image = page("none")[..., None] / PAPER * np.array(tint, float)
    for kind, x, y in hole_places(holes):
        dark, radius = [c * shadow for c in tint], round(3.2 * PIXELS_PER_MM)
        if kind == "round":
            cv2.circle(image, (x, y), radius, (PAPER,) * 3, cv2.FILLED, cv2.LINE_AA)
            cv2.ellipse(image, (x, y), (radius, radius), 0, 20, 200, dark, 2, cv2.LINE_AA)
        else:
            cv2.rectangle(image, (x - 19, y - 5), (x + 19, y + 5), (PAPER,) * 3, cv2.FILLED)
            cv2.line(image, (x - 19, y - 5), (x + 19, y - 5), dark, 2)
    grain = np.random.default_rng(0).normal(0, 2, image.shape)
    return np.clip(image + grain, 0, 255).astype(np.uint8)


@pytest.mark.parametrize("tint", [(200, 225, 240), (225, 200, 160), (180, 180, 180)])
@pytest.mark.parametrize("holes", ["acme", "file", "three"])
def test_the_rims_of_holes_in_a_tinted_sheet_are_no_lines(holes, tint):
    image = tinted(holes, tint)
    image[..., 0] -= 3  # the paper has some color
    read = scan_of(image)
    scan = set_aside(read, Settings())
    drawn = scan_of(tinted("none", tint)).ink > 0.3
    assert ((scan.ink > 0.3) == drawn).mean() > 0.9995
    assert scan.notes == (
        f"Left out as no part of the drawing: {len(hole_places(holes))} punched holes.",
    )
    true = np.array([(x + 0.5, y + 0.5) for _, x, y in hole_places(holes)])
    apart = np.hypot(*(true[:, None] - np.array(anchors_of(read))).transpose(2, 0, 1))
    assert apart.min(1).max() < 2.5  # a shadow hides a side of each
    assert set_aside(read, Settings(marks=False)).ink is read.ink


def test_white_spots_on_a_tinted_sheet_are_not_taken_for_holes():
    image = tinted("none", (225, 200, 160))
    for x, y in ((450, 640), (100, 60), (620, 80)):  # chalk, and none in a row
        cv2.circle(image, (x, y), 9, (250, 250, 250), cv2.FILLED, cv2.LINE_AA)
    read = scan_of(image)
    assert set_aside(read, Settings()).ink is read.ink


@pytest.mark.parametrize("degrees", [1.2, -0.8, 3])
def test_the_scanners_lid_around_the_page_is_a_border(degrees):
    image, _ = laid(page("acme", crosses=True), degrees, (4, -6), lid=15)
    scan = set_aside(scan_of(image), Settings())
    edge = np.ones(scan.ink.shape, bool)
    edge[30:-30, 30:-30] = False
    assert (scan.ink[edge] > 0.3).mean() < 0.002


def test_nothing_of_the_drawing_is_taken():
    plain, full = page("none"), page("acme", crosses=True)
    drawn = scan_of(plain).ink > 0.3
    scan = set_aside(scan_of(full), Settings())
    assert ((scan.ink > 0.3) == drawn).mean() > 0.9995
    assert not marks_of(plain).mask.any()


@pytest.mark.parametrize(
    "draw",
    [
        lambda image: cv2.rectangle(image, (0, 300), (899, 699), INK, cv2.FILLED),
        lambda image: cv2.rectangle(image, (20, 20), (880, 680), INK, 4),
        lambda image: cv2.line(image, (0, 90), (899, 60), INK, 6, cv2.LINE_AA),
        lambda image: [cv2.circle(image, (60 + 90 * k, 640), 10, INK, -1) for k in range(9)],
        lambda image: cv2.line(image, (450, 0), (470, 699), INK, 4, cv2.LINE_AA),
    ],
    ids=["black ground", "frame", "horizon", "dots", "line off the page"],
)
def test_drawn_things_are_not_marks(draw):
    image = page("none", drawing=False)
    draw(image)
    assert not marks_of(image).mask.any()


@pytest.mark.parametrize("width", [4, 8, 12])
def test_a_line_along_the_edge_is_drawn(width):
    image = page("none", drawing=False)
    path = [(60, 100), (60, 640), (100, 699 - width // 3), (800, 699 - width // 3), (840, 640)]
    cv2.polylines(image, [np.int32([*path, (840, 100)])], False, INK, width, cv2.LINE_AA)
    assert not marks_of(image).mask.any()
    cv2.rectangle(image, (0, 0), (SIZE[0] - 1, SIZE[1] - 1), INK, 2 * width - 1)
    assert not marks_of(image).mask.any()


def test_what_was_set_aside_is_told():
    image, _ = laid(page("acme", crosses=True), 1.2, (4, -6), lid=15)
    scan = set_aside(scan_of(image, sheet=False), Settings())
    (note,) = scan.notes
    assert "dark borders of the scan, 3 punched holes" in note
    assert not set_aside(scan_of(page("none")), Settings()).notes


def test_pages_are_brought_to_one_place():
    target = anchors_of(scan_of(page()))
    straight = set_aside(scan_of(page()), Settings())
    image, _ = laid(page(), 1.4, (7, -5))
    aligned = set_aside(scan_of(image), Settings(align=target))

    def gap(one):
        return np.abs(one.ink - straight.ink)[100:600, 100:800].mean()

    assert gap(aligned) < 0.2 * gap(scan_of(image))


def test_a_page_without_holes_stays_where_it_lies():
    scan = scan_of(page("none"))
    left = set_aside(scan, Settings(align=((1, 2), (3, 4), (5, 6))))
    assert left.ink is scan.ink
    assert not left.aligned
    assert set_aside(scan, Settings()) is scan
    assert set_aside(scan_of(page()), Settings(marks=False)).ink[640, 450] > 0.9


def test_a_page_with_other_holes_stays_where_it_lies():
    scan = scan_of(page())
    target = np.array(anchors_of(scan))
    there = set_aside(scan, Settings(align=tuple(map(tuple, target + 9.0))))
    wider = set_aside(scan, Settings(align=tuple(map(tuple, target * (1.2, 1.0)))))
    assert there.aligned
    assert not wider.aligned
    assert np.array_equal(wider.ink, set_aside(scan, Settings()).ink)


def test_pages_that_can_not_be_aligned_are_told(tmp_path, capsys):
    for number, holes in enumerate(("acme", "none", "acme", "none"), 1):
        cv2.imwrite(str(tmp_path / f"p{number}.png"), page(holes))
    report, out = tmp_path / "report.json", tmp_path / "out"
    fast = ["--provider", "classical", "--router", "geometric", "--format", "json"]
    command = ["trace", str(tmp_path), "--sequence", "-o", str(out), "--report", str(report)]
    assert main([*command, *fast, "--align"]) == 0
    (said,) = capsys.readouterr().err.splitlines()
    assert said.startswith("involute: warning: 2 pages have no holes")
    assert said.endswith(": p2.png, p4.png.")
    pages = json.loads(report.read_text("utf-8"))["images"]
    assert [page["aligned"] for page in pages] == [True, False, True, False]
    assert main([*command, *fast, "--overwrite"]) == 0
    assert not capsys.readouterr().err
    assert all("aligned" not in p for p in json.loads(report.read_text("utf-8"))["images"])


def test_rigid_motion_is_found_exactly():
    points = np.float32([[10, 20], [300, 40], [150, 200]])
    motion = cv2.getRotationMatrix2D((100, 100), 12, 1)
    motion[:, 2] += (5, -3)
    moved = points @ motion[:, :2].T + motion[:, 2]
    assert np.allclose(rigid(points, moved), motion, atol=1e-3)
