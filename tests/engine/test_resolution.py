"""Sizes in mm follow from the resolution that the file of a scan tells."""

from __future__ import annotations

import struct
import zlib

import cv2
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from involute.engine import Settings, vectorize
from involute.engine.scan.resolution import dots_per_inch

PAGE = np.full((60, 80), 255, np.uint8)
cv2.line(PAGE, (10, 12), (70, 40), 0, 2)


def png(dpi: float) -> bytes:
    data = cv2.imencode(".png", PAGE)[1].tobytes()
    body = b"pHYs" + struct.pack(">IIB", *[round(dpi / 0.0254)] * 2, 1)
    return data[:33] + struct.pack(">I", 9) + body + struct.pack(">I", zlib.crc32(body)) + data[33:]


def jpeg(dpi: int, unit: int = 1) -> bytes:
    data = bytearray(cv2.imencode(".jpg", PAGE)[1].tobytes())
    assert data[6:11] == b"JFIF\0"
    struct.pack_into(">BHH", data, 13, unit, dpi, dpi)
    return bytes(data)


def tiff(dpi: int, order: str = "<", unit: int = 2) -> bytes:
    height, width = PAGE.shape
    tags = {256: width, 257: height, 258: 8, 259: 1, 262: 1, 273: 0, 277: 1, 278: height}
    tags |= {279: PAGE.size, 282: 0, 296: unit}
    start = 8 + 2 + 12 * len(tags) + 4
    tags |= {282: start, 273: start + 8}
    entries = b"".join(
        struct.pack(order + "HHII", tag, 5 if tag == 282 else 4, 1, value)
        if tag in (282,) or tag != 296
        else struct.pack(order + "HHIHH", tag, 3, 1, value, 0)
        for tag, value in tags.items()
    )
    magic = b"II*\0" if order == "<" else b"MM\0*"
    head = magic + struct.pack(order + "IH", 8, len(tags)) + entries + struct.pack(order + "I", 0)
    return head + struct.pack(order + "II", dpi * 10, 10) + PAGE.tobytes()


def bmp(dpi: float) -> bytes:
    data = bytearray(cv2.imencode(".bmp", PAGE)[1].tobytes())
    struct.pack_into("<ii", data, 38, *[round(dpi / 0.0254)] * 2)
    return bytes(data)


@pytest.mark.parametrize(
    ("name", "data", "dpi"),
    [
        ("a.png", png(600), 600),
        ("a.jpg", jpeg(300), 300),
        ("a.jpg", jpeg(118, 2), 299.72),
        ("a.tif", tiff(400), 400),
        ("a.tif", tiff(400, ">"), 400),
        ("a.tif", tiff(200, "<", 3), 508),
        ("a.bmp", bmp(300), 300),
        ("a.png", png(72), None),
        ("a.jpg", jpeg(1, 0), None),
        ("a.tif", tiff(400, "<", 1), None),
        ("a.txt", b"no picture", None),
    ],
)
def test_the_file_tells_the_resolution(name, data, dpi, tmp_path):
    (tmp_path / name).write_bytes(data)
    found = dots_per_inch(tmp_path / name)
    assert found == (None if dpi is None else pytest.approx(dpi, abs=0.1))


def test_a_drawing_knows_how_large_its_paper_was(tmp_path):
    (tmp_path / "page.png").write_bytes(png(600))
    fast = Settings(provider="classical", router="geometric")
    drawing = vectorize(tmp_path / "page.png", fast)
    assert drawing.mm_per_px == pytest.approx(25.4 / 600, rel=1e-3)
    assert vectorize(PAGE, fast).mm_per_px == pytest.approx(25.4 / 300)


@given(st.sampled_from([png(600), jpeg(300), tiff(400), bmp(300)]), st.data())
def test_damaged_files_say_nothing_and_stop_nothing(tmp_path_factory, content, data):
    damaged = bytearray(content[: data.draw(st.integers(0, 200))])
    for place in data.draw(st.lists(st.integers(0, max(0, len(damaged) - 1)), max_size=5)):
        damaged[place : place + 1] = bytes([data.draw(st.integers(0, 255))])
    path = tmp_path_factory.mktemp("damaged") / "page"
    path.write_bytes(damaged)
    found = dots_per_inch(path)
    assert found is None or 100 <= found <= 4800
