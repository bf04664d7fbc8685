"""Every kind of picture is read as what it shows; what is not read, or lies, is said in time."""

from __future__ import annotations

import os
import secrets
import struct
import zlib
from contextlib import suppress
from pathlib import Path

import cv2
import numpy as np
import pytest
from involute.engine import InvoluteError, Settings, vectorize
from involute.engine.formats.picture_kinds import KINDS, SUFFIXES, why_left_out
from involute.engine.scan import page_count
from involute.engine.scan.image_file import read_image

GRAY = np.full((30, 40), 255, np.uint8)
cv2.line(GRAY, (3, 4), (36, 20), 0, 2)
GRAY[2:6, 2:9] = 90  # not symmetric in any way
COLOR = np.dstack([GRAY, np.full_like(GRAY, 200), GRAY // 2])  # RGB
ALPHA = np.dstack([COLOR, 255 - GRAY])


def tiff(array: np.ndarray, *, big_endian=False, tile=0, pack=None, code=1, **tags: int) -> bytes:
    """A TIFF of one page."""
    order = ">" if big_endian else "<"
    array = array.astype(array.dtype.newbyteorder(order))
    height, width = array.shape[:2]
    samples = 1 if array.ndim == 2 else array.shape[2]
    pieces = [array]
    if tile:
        padded = np.pad(array, ((0, -height % tile), (0, -width % tile)))
        pieces = [
            padded[y : y + tile, x : x + tile]
            for y in range(0, height, tile)
            for x in range(0, width, tile)
        ]
    raw = [(pack or bytes)(piece.tobytes()) for piece in pieces]
    kind = {"u": 1, "i": 2, "f": 3}[array.dtype.kind]
    values = {256: width, 257: height, 258: 8 * array.dtype.itemsize, 259: code, 262: 1}
    values |= {277: samples, 278: height, 339: kind} | {int(k[1:]): v for k, v in tags.items()}
    if tile:
        values |= {322: tile, 323: tile}
    offsets = 8 + 2 + 12 * (len(values) + 2) + 4
    data = offsets + 8 * len(raw)
    starts = data + np.concatenate([[0], np.cumsum([len(r) for r in raw])])[:-1]
    entries = [(tag, 4, 1, value) for tag, value in values.items()]
    where = (324, 325) if tile else (273, 279)
    one = len(raw) == 1
    entries.append((where[0], 4, len(raw), int(starts[0]) if one else offsets))
    entries.append((where[1], 4, len(raw), len(raw[0]) if one else offsets + 4 * len(raw)))
    return b"".join(
        [
            b"MM\0*" if big_endian else b"II*\0",
            struct.pack(order + "IH", 8, len(entries)),
            *(struct.pack(order + "HHII", *entry) for entry in sorted(entries)),
            struct.pack(order + "I", 0),
            struct.pack(f"{order}{len(raw)}I", *map(int, starts)),
            struct.pack(f"{order}{len(raw)}I", *map(len, raw)),
            *raw,
        ]
    )


def tga(picture: np.ndarray, kind: int, how: int = 0, pixels: bytes | None = None) -> bytes:
    height, width = picture.shape[:2]
    bits = 8 if picture.ndim == 2 else 8 * picture.shape[2]
    head = struct.pack("<BBBHHBHHHHBB", 0, 0, kind, 0, 0, 0, 0, 0, width, height, bits, how)
    if pixels is None:
        pixels = bgr(picture)[:: 1 if how & 32 else -1].tobytes()
    return head + pixels


def bgr(picture: np.ndarray) -> np.ndarray:
    if picture.ndim == 2:
        return picture
    return picture[..., [2, 1, 0, 3][: picture.shape[2]]]


def runs(picture: np.ndarray) -> bytes:
    """Targa's packets: runs of two, and one literal stretch."""
    flat = bgr(picture).reshape(picture.shape[0] * picture.shape[1], -1)
    out, at = b"", 0
    while at < len(flat):
        if at + 1 < len(flat) and (flat[at] == flat[at + 1]).all():
            out, at = out + b"\x81" + flat[at].tobytes(), at + 2
        else:
            out, at = out + b"\0" + flat[at].tobytes(), at + 1
    return out


def psd(
    planes: list[np.ndarray], mode: int, *, layers: int = 0, merged=True, packed=False
) -> bytes:
    height, width = planes[0].shape
    info = b"8BIM" + struct.pack(">HHI", 1057, 0, 5) + struct.pack(">IB", 1, merged) + b"\0"
    layer = struct.pack(">Ih", 2, layers)
    body = b"".join(plane.astype(plane.dtype.newbyteorder(">")).tobytes() for plane in planes)
    if packed:  # PackBits: one literal stretch a row
        lines = [bytes([width - 1]) + row.tobytes() for plane in planes for row in plane]
        body = b"".join(struct.pack(">H", len(line)) for line in lines) + b"".join(lines)
    return b"".join(
        [
            b"8BPS\0\1" + b"\0" * 6,
            struct.pack(">HIIHH", len(planes), height, width, 8 * planes[0].itemsize, mode),
            struct.pack(">I", 0),
            struct.pack(">I", len(info)) + info,
            struct.pack(">I", len(layer)) + layer,
            struct.pack(">H", packed) + body,
        ]
    )


def bmp_with_alpha() -> bytes:
    pixels = bgr(ALPHA)[::-1].tobytes()
    info = struct.pack("<IiiHHIIiiII", 108, 40, 30, 1, 32, 3, len(pixels), 0, 0, 0, 0)
    info += struct.pack("<4I", 0xFF0000, 0xFF00, 0xFF, 0xFF000000) + b"\0" * 52
    return b"BM" + struct.pack("<IHHI", 122 + len(pixels), 0, 0, 122) + info + pixels


def encoded(suffix: str, picture: np.ndarray) -> bytes:
    return cv2.imencode(suffix, bgr(picture))[1].tobytes()


def packed_bits(data: bytes) -> bytes:
    return b"".join(b"\0" + data[k : k + 1] for k in range(len(data)))


def coded(data: bytes) -> bytes:
    """LZW of TIFF that starts a new table before it ever grows: codes of 9 bits."""
    bits = ""
    for at in range(0, len(data), 200):
        bits += f"{256:09b}" + "".join(f"{byte:09b}" for byte in data[at : at + 200])
    bits += f"{257:09b}"
    bits += "0" * (-len(bits) % 8)
    return int(bits, 2).to_bytes(len(bits) // 8, "big")


DEEP = GRAY.astype(np.uint32) * 16843009
FILES = {
    "tga-gray.tga": (tga(GRAY, 3), GRAY),
    "tga-color.tga": (tga(COLOR, 2), COLOR),
    "tga-downward.tga": (tga(COLOR, 2, 32), COLOR),
    "tga-runs.tga": (tga(COLOR, 10, 32, runs(COLOR)), COLOR),
    "tga-gray-runs.tga": (tga(GRAY, 11, 32, runs(GRAY)), GRAY),
    "tga-alpha.tga": (tga(ALPHA, 2, 32 | 8), ALPHA),
    "tga-no-alpha.tga": (tga(np.dstack([COLOR, GRAY * 0]), 2, 32), COLOR),
    "psd-gray.psd": (psd([GRAY], 1), GRAY),
    "psd-packed.psd": (psd([*np.moveaxis(COLOR, 2, 0)], 3, packed=True), COLOR),
    "psd-transparent.psd": (psd([*np.moveaxis(ALPHA, 2, 0)], 3, layers=-2), ALPHA),
    "psd-selection.psd": (psd([*np.moveaxis(ALPHA, 2, 0)], 3, layers=2), COLOR),
    "psd-16.psd": (psd([GRAY.astype(np.uint16) * 257], 1), GRAY.astype(np.uint16) * 257),
    "tif-gray-alpha.tif": (tiff(ALPHA[..., [0, 3]]), ALPHA[..., [0, 0, 0, 3]]),
    "tif-tiles-of-16.tif": (tiff(GRAY, tile=16), GRAY),
    "tif-f16.tif": (tiff((GRAY / 255).astype(np.float16)), (GRAY / 255).astype(np.float16)),
    "tif-u32.tif": (tiff(DEEP, big_endian=True), GRAY.astype(np.uint16) * 257),
    "tif-u32-deflate.tif": (tiff(DEEP, pack=zlib.compress, code=8), GRAY.astype(np.uint16) * 257),
    "tif-u32-packbits.tif": (
        tiff(DEEP, pack=packed_bits, code=32773),
        GRAY.astype(np.uint16) * 257,
    ),
    "tif-u32-lzw.tif": (tiff(DEEP, pack=coded, code=5), GRAY.astype(np.uint16) * 257),
    "tif-turned.tif": (tiff(DEEP, t274=3), GRAY[::-1, ::-1].astype(np.uint16) * 257),
    "bmp-alpha.bmp": (bmp_with_alpha(), ALPHA),
    "gif.gif": (encoded(".gif", np.dstack([GRAY] * 3)), np.dstack([GRAY] * 3)),
    "pgm.pgm": (encoded(".pgm", GRAY), GRAY),
    "ppm.ppm": (encoded(".ppm", COLOR), COLOR),
    "png-named-tif.tif": (encoded(".png", COLOR), COLOR),
    "tif-named-tga.tga": (encoded(".tif", COLOR), COLOR),
}


@pytest.mark.parametrize("name", FILES)
def test_pictures_are_read_as_what_they_show(name, tmp_path):
    data, wanted = FILES[name]
    (tmp_path / name).write_bytes(data)
    assert page_count(tmp_path / name) == 1
    picture = read_image(tmp_path / name)
    assert picture.shape == wanted.shape
    off = np.abs(picture.astype(float) - wanted.astype(float))
    assert off.mean() < 3 if name.endswith(".gif") else off.max() == 0  # a GIF has a palette


@pytest.mark.parametrize("suffix", [".jp2", ".avif"])
def test_pictures_that_lose_a_little_are_read(suffix, tmp_path):
    big = cv2.resize(COLOR, None, fx=8, fy=8, interpolation=cv2.INTER_AREA)
    (tmp_path / f"x{suffix}").write_bytes(encoded(suffix, big))
    picture = read_image(tmp_path / f"x{suffix}")
    assert picture.shape == big.shape
    assert np.abs(picture.astype(float) - big).mean() < 6


@pytest.mark.parametrize("name", FILES)
def test_a_picture_out_of_a_pipe_has_no_name_to_go_by(name, tmp_path):
    data, _ = FILES[name]
    (tmp_path / name).write_bytes(data)
    (tmp_path / "stdin").write_bytes(data)
    assert np.array_equal(read_image(tmp_path / "stdin"), read_image(tmp_path / name))


@pytest.mark.parametrize("name", FILES)
def test_cut_pictures_are_damaged_never_a_crash(name, tmp_path):
    data, _ = FILES[name]
    for size in (*range(0, min(60, len(data)), 7), len(data) // 2, len(data) - 50):
        (tmp_path / name).write_bytes(data[:size])
        page_count(tmp_path / name)
        with suppress(InvoluteError):
            read_image(tmp_path / name)


@pytest.mark.parametrize(
    ("name", "head", "says"),
    [
        ("a.png", b"\0\0\0\x0cJXL \r\n\x87\n", "JPEG XL, which is not read"),
        ("a.jxl", b"\0\0\0\x0cJXL \r\n\x87\n", "JPEG XL, which is not read"),
        ("a.kra", b"PK\3\4", "Krita, which is not read"),
        ("a.txt", b"some words", "not a picture of a kind that is read; give PNG"),
        ("a.png", b"\x89PNG\r\n\x1a\n\0\0", "a.png is damaged; give a whole PNG file"),
        ("a.psd", psd([GRAY], 1, merged=False), "Maximize Compatibility"),
    ],
)
def test_what_is_not_read_is_not_called_damaged(name, head, says, tmp_path):
    (tmp_path / name).write_bytes(head)
    with pytest.raises(InvoluteError, match=says):
        read_image(tmp_path / name)


def test_folders_know_what_is_read():
    assert {".tga", ".psd", ".gif", ".png", ".jp2", ".avif", ".pgm"} <= set(SUFFIXES)
    assert why_left_out(Path("x.TGA")) is None
    assert "Krita is not read: save it" in why_left_out(Path("x.KRA"))
    assert why_left_out(Path("notes.txt")) == "not a picture"
    every = [suffix for kind in KINDS for suffix in kind.suffixes]
    assert len(every) == len(set(every))


def overlapping(directories: int, entries: int) -> bytes:
    """A TIFF whose long directories lie in each other."""
    out = bytearray(b"II*\0" + struct.pack("<I", 8))
    out += b"\0" * (2 + 12 * entries + 4 + 12 * directories)
    for k in range(directories):
        at = 8 + 12 * k
        out[at : at + 2] = struct.pack("<H", entries)
        following = at + 12 if k + 1 < directories else 0
        out[at + 2 + 12 * entries : at + 6 + 12 * entries] = struct.pack("<I", following)
    return bytes(out)


def lying_jpeg() -> bytes:
    """Says that it has 20,000 px a side."""
    data = bytearray(encoded(".jpg", GRAY))
    at = data.find(b"\xff\xc0")
    data[at + 5 : at + 9] = struct.pack(">HH", 20_000, 20_000)
    return bytes(data)


def lying_png() -> bytes:
    """Says that it has 20,000 px a side, with a checksum that fits."""
    data = bytearray(encoded(".png", GRAY))
    data[16:24] = struct.pack(">II", 20_000, 20_000)
    data[29:33] = struct.pack(">I", zlib.crc32(data[12:29]))
    return bytes(data)


def long_png() -> bytes:
    """Says that its pixels take up 4 GB of the file, for which OpenCV made room."""
    data = bytearray(encoded(".png", GRAY))
    data[16:24] = struct.pack(">II", 40_000, 40_000)
    data[33:37] = b"\xff" * 4
    return bytes(data)


@pytest.mark.parametrize(
    "data",
    [
        b"II+\0\x08\0\0\0" + b"\xff" * 8 + b"\0" * 40,  # 56 bytes: a directory far outside
        b"II+\0\x08\0\0\0" + struct.pack("<QQ", 16, 2**63) + b"\0" * 400,
        b"II*\0\xff\xff\xff\xff" + b"\0" * 40,
        b"II*\0\x08\0\0\0\xff\xff",
        overlapping(300, 60_000),  # hung
        tiff(DEEP, t256=2**31, t257=2**31),
        tiff(DEEP, t322=0, t323=0, t324=8),
        lying_jpeg(),
        lying_png(),
        long_png(),
        b"GIF89a" + struct.pack("<HH", 20_000, 20_000) + encoded(".gif", COLOR)[10:],
        tga(GRAY, 11, 0, b"\x81\0")[:12] + struct.pack("<HH", 65535, 65535) + b"\x08\0\x81\0",
    ],
)
def test_files_that_lie_are_refused_at_once(data, tmp_path):
    path = tmp_path / ("x.tga" if data[0] == 0 else "x.img")
    path.write_bytes(data)
    assert page_count(path) >= 1
    with pytest.raises(InvoluteError, match="damaged"):
        read_image(path)


MUTATIONS = 300  # pictures in a run


def test_damaged_pictures_are_read_or_refused(tmp_path):
    """Whatever is wrong with a file; what was found so stands above, in FILES and what lies."""
    seed = secrets.randbits(32)
    print(f"seed {seed}")
    random = np.random.default_rng(seed)
    names = list(FILES)
    for count in range(MUTATIONS):
        name = names[int(random.integers(len(names)))]
        path = tmp_path / name
        path.write_bytes(damaged(FILES[name][0], random))
        try:
            assert page_count(path) >= 1
            picture = read_image(path)
        except InvoluteError as error:
            said = str(error)
            assert name in said, f"seed {seed}, {count}"
            assert "\n" not in said, f"seed {seed}, {count}"
        except Exception as error:
            raise AssertionError(f"seed {seed}, {count}: {name}") from error
        else:
            assert picture.ndim in (2, 3), f"seed {seed}, {count}"
            assert max(picture.shape[:2]) <= 20_000, f"seed {seed}, {count}"


def damaged(data: bytes, random: np.random.Generator) -> bytes:
    """A file with something wrong in it, mostly in its head, where sizes and places stand."""
    found = bytearray(data)
    for _ in range(int(random.integers(1, 4))):
        length = max(1, len(found))
        at = int(random.integers(min(length, 400) if random.random() < 0.7 else length))
        size = int(random.integers(1, 9))
        how = int(random.integers(5))
        if how == 0:
            found[at : at + size] = random.bytes(size)
        elif how == 1:
            found[at : at + size] = random.choice([b"\0", b"\xff", b"\x7f", b"\x80"]) * size
        elif how == 2:
            del found[at : at + int(random.integers(1, 60))]
        elif how == 3:
            found[at:at] = found[at : at + int(random.integers(1, 60))]
        else:
            del found[at:]
    return bytes(found)


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="no pipes with names here")
def test_a_named_pipe_is_not_waited_for(tmp_path):
    os.mkfifo(tmp_path / "pipe.png")
    for read in (read_image, page_count):
        with pytest.raises(InvoluteError, match="no file"):
            read(tmp_path / "pipe.png")
    for name in ("", "a\0b", "x" * 5000, "\udcff.png", 3, [[0, 1]]):
        with pytest.raises(InvoluteError):
            read_image(name)


@pytest.mark.parametrize("shape", [(16, 20_000), (20_000, 16), (16, 16)])
def test_long_strips_of_paper_are_traced(shape):
    blank = vectorize(np.full(shape, 255, np.uint8), Settings(provider="classical"))
    assert blank.strokes == ()


def test_a_psd_without_a_flattened_picture_is_named_and_says_how_to_save_it(tmp_path):
    data = bytearray(FILES["psd-packed.psd"][0])
    data[data.index(b"8BIM\x04\x21") + 16] = 0  # its flag: there is a flattened picture
    path = tmp_path / "layers.psd"
    path.write_bytes(data)
    with pytest.raises(InvoluteError, match=r"layers\.psd: the PSD .* 'Maximize Compatibility'"):
        read_image(path)
