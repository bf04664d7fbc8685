"""PDF, HEIC and OpenEXR: read where their libraries are, and else told what to do."""

from __future__ import annotations

import io
import sys
from pathlib import Path

import cv2
import numpy as np
import OpenEXR
import pillow_heif
import pypdfium2
import pytest
from involute.command.cli import main
from involute.engine import Drawing, InvoluteError, vectorize
from involute.engine.formats import picture_kinds
from involute.engine.scan import page_count
from involute.engine.scan.image_file import read_image
from involute.engine.scan.resolution import dots_per_inch

SIZE = (600, 400)  # px
GRAY = np.full(SIZE[::-1], 240, np.uint8)
cv2.circle(GRAY, (200, 180), 120, 20, 5, cv2.LINE_AA)
cv2.line(GRAY, (60, 300), (560, 90), 20, 5, cv2.LINE_AA)
COLOR = np.dstack([GRAY, np.full_like(GRAY, 230), np.maximum(GRAY, 90)])


def pdf(pages: int = 1, inches: tuple[float, float] = (2.0, 4 / 3)) -> bytes:
    """A circle and a line on each page, and as many short lines as its number."""
    document = pypdfium2.PdfDocument.new()
    raw, width, height = pypdfium2.raw, *(72 * side for side in inches)
    for number in range(pages):
        sheet = document.new_page(width, height)
        marks = [(20, 15, 130, 80)] + [(20 + 12 * k, 5, 26 + 12 * k, 5) for k in range(number)]
        for x, y, u, v in marks:
            line = raw.FPDFPageObj_CreateNewPath(x, y)
            raw.FPDFPath_LineTo(line, u, v)
            raw.FPDFPageObj_SetStrokeWidth(line, 1.2)
            raw.FPDFPath_SetDrawMode(line, raw.FPDF_FILLMODE_NONE, True)
            raw.FPDFPage_InsertObject(sheet, line)
        raw.FPDFPage_GenerateContent(sheet)
    file = io.BytesIO()
    document.save(file)
    return file.getvalue()


def heic(picture: np.ndarray) -> bytes:
    mode = "L" if picture.ndim == 2 else "RGB"
    file = io.BytesIO()
    made = pillow_heif.from_bytes(mode, picture.shape[1::-1], picture.tobytes())
    made.save(file, quality=95)
    return file.getvalue()


def exr(path: Path, picture: np.ndarray, kind: str = "RGB") -> None:
    linear = (picture.astype(np.float32) / 255) ** 2.2
    header = {"compression": OpenEXR.ZIP_COMPRESSION, "type": OpenEXR.scanlineimage}
    OpenEXR.File(header, {kind: linear.astype(np.float16)}).write(str(path))


def test_every_page_of_a_pdf_is_a_drawing_at_300_dpi(tmp_path):
    path = tmp_path / "book.pdf"
    path.write_bytes(pdf(3))
    assert page_count(path) == 3
    assert read_image(path).shape[:2] == (400, 600)
    assert dots_per_inch(path) == 300
    for page in range(3):
        drawing = vectorize(path, page=page)
        assert len(drawing.strokes) == 1 + page
        assert drawing.dpi == 300
    with pytest.raises(InvoluteError, match="damaged"):
        read_image(path, 3)


def test_a_folder_traces_the_pages_of_its_pdfs(tmp_path):
    (tmp_path / "in").mkdir()
    (tmp_path / "in" / "book.pdf").write_bytes(pdf(2))
    assert main(["trace", str(tmp_path / "in"), "-o", str(tmp_path / "out"), "--quiet"]) == 0
    assert len(list((tmp_path / "out").glob("*.svg"))) == 2


@pytest.mark.parametrize("picture", [GRAY, COLOR], ids=["gray", "color"])
def test_a_heic_shows_what_it_shows(picture, tmp_path):
    (tmp_path / "photo.heic").write_bytes(heic(picture))
    read = read_image(tmp_path / "photo.heic")
    shown = read if read.ndim == picture.ndim else read[..., 0]
    assert np.abs(shown.astype(float) - picture).mean() < 4
    assert len(vectorize(tmp_path / "photo.heic").strokes) == 2


@pytest.mark.parametrize(("picture", "kind"), [(GRAY, "Y"), (COLOR, "RGB")])
def test_an_exr_is_read_as_one_sees_it(picture, kind, tmp_path):
    exr(tmp_path / "frame.exr", picture, kind)
    read = read_image(tmp_path / "frame.exr")
    assert np.abs(255 * read - picture).max() < 10  # sRGB is not quite a power
    assert len(vectorize(tmp_path / "frame.exr").strokes) == 2


def test_they_come_through_a_pipe(tmp_path, monkeypatch):
    exr(tmp_path / "a.exr", COLOR)
    for data in (pdf(), heic(COLOR), (tmp_path / "a.exr").read_bytes()):
        monkeypatch.setattr(sys, "stdin", io.TextIOWrapper(io.BytesIO(data)))
        target = tmp_path / "out.json"
        assert main(["trace", "-", "-o", str(target), "--overwrite", "--quiet"]) == 0
        assert len(Drawing.load(target).strokes) in (1, 2)


@pytest.mark.parametrize("name", ["a.pdf", "a.heic", "a.exr"])
def test_cut_files_are_damaged_never_a_crash(name, tmp_path):
    path = tmp_path / name
    if name == "a.exr":
        exr(path, COLOR)
        data = path.read_bytes()
    else:
        data = pdf() if name == "a.pdf" else heic(COLOR)
    for size in (20, 60, len(data) // 3):
        path.write_bytes(data[:size])
        assert page_count(path) == 1
        with pytest.raises(InvoluteError, match="damaged"):
            read_image(path)


def test_a_page_as_large_as_a_house_is_refused_before_room_is_made(tmp_path):
    (tmp_path / "plan.pdf").write_bytes(pdf(1, (120.0, 90.0)))
    with pytest.raises(InvoluteError, match=r"plan\.pdf is too large"):
        read_image(tmp_path / "plan.pdf")


@pytest.mark.parametrize(
    ("name", "module", "says"),
    [
        ("a.pdf", "pypdfium2", "PDF, which is not read; save its pages as PNG"),
        ("a.heic", "pillow_heif", "HEIC, which is not read; save it as PNG or JPEG"),
        ("a.exr", "OpenEXR", "OpenEXR, which is not read; save it"),
    ],
)
def test_without_the_library_it_says_what_to_do(name, module, says, tmp_path, monkeypatch):
    real = picture_kinds.find_spec
    missing = lambda wanted: None if wanted == module else real(wanted)  # noqa: E731
    monkeypatch.setattr(picture_kinds, "find_spec", missing)
    monkeypatch.setitem(sys.modules, module, None)
    for kind in picture_kinds.KINDS:
        kind.__dict__.pop("is_read", None)
    try:
        path = tmp_path / name
        head = {"a.pdf": b"%PDF-1.7\n", "a.heic": b"\0\0\0\x18ftypheic\0\0\0\0"}
        path.write_bytes(head.get(name, b"\x76\x2f\x31\x01\2\0\0\0"))
        with pytest.raises(InvoluteError, match=says):
            read_image(path)
        assert "is not read" in picture_kinds.why_left_out(path)
    finally:
        for kind in picture_kinds.KINDS:
            kind.__dict__.pop("is_read", None)


def test_a_pdf_whose_page_is_damaged_is_told(tmp_path):
    path = tmp_path / "torn.pdf"
    whole = pdf()
    assert b"/Type/Page>>" in whole
    path.write_bytes(whole.replace(b"/Type/Page>>", b"/Type/Pa@e>>"))
    with pytest.raises(InvoluteError, match="damaged"):
        read_image(path)
