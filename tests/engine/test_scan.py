"""Any picture of a drawing becomes even ink, or an error that says what to do."""

from __future__ import annotations

import itertools
import struct
from pathlib import Path

import cv2
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp
from involute.engine import InvoluteError, Settings
from involute.engine.scan import page_count, read_scan
from involute.engine.scan.paper import flatten_paper
from involute.engine.scan.pen_width import measure_pen
from involute.engine.scan.picture import checked_picture
from involute.engine.scan.polarity import is_light_on_dark

DATA = Path(__file__).parent / "data"
SETTINGS = Settings()


def page(width: int = 320, height: int = 240, pen: float = 3) -> np.ndarray:
    """Black lines on white, (H, W) uint8; nothing symmetric about it."""
    return drawn(
        (height, width),
        pen,
        [[20, 30], [width - 30, 60]],
        [[50, 20], [80, height - 20]],
        circle((width / 2, height / 2 + 20), height / 4),
    )


def circle(center: tuple[float, float], radius: float) -> np.ndarray:
    angle = np.linspace(0, 2 * np.pi, 100)
    return center + radius * np.stack([np.cos(angle), np.sin(angle)], 1)


def drawn(shape: tuple[int, int], pen: float, *lines) -> np.ndarray:
    """Polylines of an exact width, anti-aliased; OpenCV's own are up to 2 px too wide."""
    fine = np.full((shape[0] * 8, shape[1] * 8), 255, np.uint8)
    for line in lines:
        points = np.asarray(line, float) * 8 - 0.5
        for a, b in itertools.pairwise(points):
            across = np.array([a[1] - b[1], b[0] - a[0]]) / np.hypot(*(b - a)) * pen * 4
            corners = np.stack([a + across, b + across, b - across, a - across])
            cv2.fillPoly(fine, [np.round(corners).astype(np.int32)], 0)
    return cv2.resize(fine, shape[::-1], interpolation=cv2.INTER_AREA)


def ink_of(picture, **changes) -> np.ndarray:
    return read_scan(picture, Settings(**changes)).ink


def assert_same_lines(ink: np.ndarray, picture: np.ndarray) -> None:
    """The ink is where the picture (H, W) uint8 is black, and nowhere else."""
    assert ink.shape == picture.shape
    assert ink[picture < 20].min() > 0.5
    far = cv2.erode(picture, np.ones((5, 5), np.uint8)) == 255
    assert ink[far].max() < 0.1


# --- files -----------------------------------------------------------------------------------


@pytest.mark.parametrize("suffix", [".png", ".jpg", ".tif", ".webp", ".bmp"])
def test_formats(suffix, tmp_path):
    path = tmp_path / f"Zeichnung 線画{suffix}"
    path.write_bytes(cv2.imencode(suffix, page())[1].tobytes())
    scan = read_scan(path, SETTINGS)
    assert_same_lines(scan.ink, page())
    assert scan.size == (320, 240)
    assert page_count(path) == 1


@pytest.mark.parametrize("suffix", [".png", ".tif"])
def test_16_bit(suffix, tmp_path):
    path = tmp_path / f"page{suffix}"
    cv2.imwrite(str(path), page().astype(np.uint16) * 257)
    np.testing.assert_allclose(read_scan(path, SETTINGS).ink, ink_of(page()), atol=1e-4)


def test_float_tiff_of_any_range(tmp_path):
    path = tmp_path / "page.tif"
    cv2.imwrite(str(path), page().astype(np.float32) * 100)
    np.testing.assert_allclose(read_scan(path, SETTINGS).ink, ink_of(page()), atol=1e-4)


def test_cmyk_jpeg_is_not_inverted():
    scan = read_scan(DATA / "cmyk.jpg", SETTINGS)
    assert scan.size == (40, 32)
    assert scan.color[2, 2].min() > 240
    red, green, blue = scan.color[23, 20].astype(int)
    assert red > 180 > 80 > max(green, blue)


@pytest.mark.parametrize("orientation", range(1, 9))
@pytest.mark.parametrize("suffix", [".jpg", ".png", ".webp", ".tif"])
def test_pictures_are_turned_upright(suffix, orientation, tmp_path):
    upright = page(96, 64)
    # How a camera that was turned has stored it: the inverse of what the tag asks for.
    stored = {
        1: lambda p: p,
        2: lambda p: p[:, ::-1],
        3: lambda p: p[::-1, ::-1],
        4: lambda p: p[::-1],
        5: lambda p: p.T,
        6: lambda p: p.T[::-1],
        7: lambda p: p[::-1, ::-1].T,
        8: lambda p: p.T[:, ::-1],
    }[orientation](upright)
    path = tmp_path / f"page{suffix}"
    if suffix == ".tif":
        path.write_bytes(tiff([stored], orientation=orientation))
    else:
        exif = b"II*\0" + struct.pack("<IHHHIHHI", 8, 1, 0x112, 3, 1, orientation, 0, 0)
        kinds, chunks = [cv2.IMAGE_METADATA_EXIF], [np.frombuffer(exif, np.uint8)]
        color = np.ascontiguousarray(np.repeat(stored[..., None], 3, 2))
        path.write_bytes(cv2.imencodeWithMetadata(suffix, color, kinds, chunks)[1].tobytes())
    assert_same_lines(read_scan(path, SETTINGS).ink, upright)


def tiff(
    pages: list[np.ndarray],
    orientation: int = 1,
    thumbnails: bool = False,
    big_endian: bool = False,
) -> bytes:
    """An uncompressed grey TIFF; with thumbnails, each page is followed by a reduced copy."""
    order = ">" if big_endian else "<"
    images = [(p, 0) for p in pages]
    if thumbnails:
        images = [entry for p in pages for entry in ((p, 0), (p[::4, ::4], 1))]
    out = bytearray((b"MM\0*" if big_endian else b"II*\0") + bytes(4))
    link = 4
    for picture, subfile in images:
        data = np.ascontiguousarray(picture).tobytes()
        strip = len(out)
        out += data + b"\0" * (len(data) % 2)
        struct.pack_into(order + "I", out, link, len(out))
        height, width = picture.shape
        tags = [(254, 4, subfile), (256, 4, width), (257, 4, height), (258, 3, 8), (259, 3, 1)]
        tags += [(262, 3, 1), (273, 4, strip), (274, 3, orientation), (277, 3, 1)]
        tags += [(278, 4, height), (279, 4, len(data))]
        out += struct.pack(order + "H", len(tags))
        for tag, kind, value in tags:
            field = struct.pack(order + ("Hxx" if kind == 3 else "I"), value)
            out += struct.pack(order + "HHI", tag, kind, 1) + field
        link = len(out)
        out += bytes(4)
    return bytes(out)


@pytest.mark.parametrize("thumbnails", [False, True])
@pytest.mark.parametrize("big_endian", [False, True])
def test_pages_of_a_tiff(thumbnails, big_endian, tmp_path):
    pages = [page(160, 120), page(200, 100), page(120, 120)]
    path = tmp_path / "pages.tif"
    path.write_bytes(tiff(pages, thumbnails=thumbnails, big_endian=big_endian))
    assert page_count(path) == 3
    for number, picture in enumerate(pages):
        assert_same_lines(read_scan(path, SETTINGS, page=number).ink, picture)
    with pytest.raises(InvoluteError):
        read_scan(path, SETTINGS, page=3)


# --- pictures --------------------------------------------------------------------------------


@pytest.mark.parametrize("kind", [np.uint8, np.uint16, np.float32, np.float64])
@pytest.mark.parametrize("channels", [0, 1, 3, 4])
def test_arrays(kind, channels):
    top = 1.0 if np.issubdtype(kind, np.floating) else np.iinfo(kind).max
    picture = (page() / 255.0 * top).astype(kind)
    if channels:
        picture = np.repeat(picture[..., None], channels, axis=2)
    if channels == 4:
        picture[..., 3] = top
    scan = read_scan(picture, SETTINGS)
    assert_same_lines(scan.ink, page())
    assert scan.ink.dtype == np.float32


def test_alpha_lies_over_white():
    picture = np.zeros((240, 320, 4), np.uint8)
    picture[..., 3] = 255 - page()
    assert_same_lines(ink_of(picture), page())


@pytest.mark.parametrize(
    ("paper", "line"),
    [
        ((255, 255, 255), (0, 0, 0)),
        ((0, 0, 0), (255, 255, 255)),
        ((30, 60, 150), (235, 240, 255)),  # blueprint
        ((35, 60, 45), (240, 230, 90)),  # chalk
        ((225, 205, 170), (60, 50, 50)),  # old paper
        ((255, 255, 255), (250, 220, 60)),  # yellow pencil
        ((255, 255, 255), (120, 190, 240)),  # non-photo blue
    ],
)
def test_polarity_and_colored_inks(paper, line):
    amount = (255 - page()[..., None]) / 255.0
    picture = np.round(amount * line + (1 - amount) * paper).astype(np.uint8)
    ink = ink_of(picture)
    assert ink[page() < 20].min() > 0.5
    assert ink[page() == 255].max() < 0.1


def test_polarity_can_be_told():
    assert_same_lines(ink_of(255 - page(), polarity="light"), page())
    mostly_black = np.zeros((200, 200), np.uint8)
    mostly_black[90:110] = 255
    assert ink_of(mostly_black, polarity="dark")[20, 20] > 0.9


@pytest.mark.parametrize("light", [False, True])
@pytest.mark.parametrize("width", [1, 4, 12, 20])
def test_a_frame_on_the_picture_s_edge_is_ink_and_no_paper(width, light):
    picture = page()
    cv2.rectangle(picture, (0, 0), tuple(s - 1 for s in picture.shape[::-1]), 0, 2 * width - 1)
    assert is_light_on_dark(255 - picture if light else picture, SETTINGS) is light


@pytest.mark.parametrize("line", [255, 0, 128])
@pytest.mark.parametrize("dtype", [np.uint8, np.uint16, np.float32])
def test_lines_on_a_transparent_ground_show_whatever_their_lightness(line, dtype):
    picture = np.full((*page().shape, 4), line, np.uint8)
    picture[..., 3] = 255 - page()
    top = 1 if dtype is np.float32 else np.iinfo(dtype).max
    assert_same_lines(ink_of((picture / 255 * top).astype(dtype)), page())


def test_a_painted_figure_on_a_transparent_ground_lies_on_white():
    picture = np.full((*page().shape, 4), 235, np.uint8)  # light paint with dark lines
    picture[20:-20, 20:-20, :3] = page()[20:-20, 20:-20, None]
    picture[..., 3] = 0
    picture[10:-10, 10:-10, 3] = 255
    assert not is_light_on_dark(checked_picture(picture, 0), SETTINGS)


def test_light_lines_keep_their_hue():
    picture = np.zeros((100, 100, 3), np.uint8)
    cv2.line(picture, (10, 50), (90, 50), (255, 0, 0), 5)
    cv2.line(picture, (50, 10), (50, 40), (255, 255, 255), 5)
    scan = read_scan(picture, SETTINGS)
    assert scan.color[50, 30].tolist() == [255, 0, 0]
    assert scan.color[20, 50].tolist() == [0, 0, 0]
    assert scan.color[5, 5].tolist() == [255, 255, 255]


def test_given_centerlines_stay_untouched():
    centerline = 255 - page()
    scan = read_scan(centerline, Settings(provider="given"))
    np.testing.assert_allclose(scan.ink, centerline / 255.0, atol=1e-6)
    assert scan.scale == 1.0


def with_noise(picture: np.ndarray, sigma: float, seed: int = 0) -> np.ndarray:
    noise = np.random.default_rng(seed).normal(0, sigma, picture.shape)
    return np.clip(picture + noise, 0, 255).astype(np.uint8)


def test_shadow_and_grain_are_no_ink():
    clean = page(640, 480)
    shade = np.linspace(1.0, 0.6, 640)[None] * np.ones((480, 1))
    shade[200:] *= 0.85
    cv2.GaussianBlur(shade, (0, 0), 12, dst=shade)
    ink = ink_of(with_noise(clean * 0.95 * shade, 5))
    assert np.median(ink[clean < 20]) > 0.9
    assert (ink[clean == 255] > 0.2).mean() < 1e-3


@pytest.mark.parametrize("shift", [(1, 0), (0, 2), (3, 3)])
def test_a_drawing_has_the_same_ink_wherever_it_lies(shift):
    rng = np.random.default_rng(1)
    shade = np.linspace(0.75, 0.95, 320)[None] + rng.normal(0, 0.01, (240, 320))
    gray = np.minimum(page() / 255.0, 1) * shade
    down, right = shift
    moved = cv2.copyMakeBorder(gray, down, 0, right, 0, cv2.BORDER_REPLICATE)
    ink, again = flatten_paper(gray), flatten_paper(moved)[down:, right:]
    assert ink.max() > 0.9
    np.testing.assert_allclose(ink, again, atol=1e-3)


@pytest.mark.parametrize("gap", [5, 6, 8])
@pytest.mark.parametrize("tone", [0.75, 0.95])
def test_close_hatching_of_a_grainy_pen_is_ink_though_it_hides_the_paper(gap, tone):
    rng = np.random.default_rng(gap)
    lines = [[[120, y], [230, y]] for y in range(60, 200, gap)]
    hatching = 1 - drawn((260, 360), 5, *lines) / 255
    outline = 1 - drawn((260, 360), 4, [[30, 20], [40, 240]], [[30, 20], [330, 30]]) / 255
    tooth = cv2.GaussianBlur(rng.normal(size=(260, 360)), (0, 0), 1.2)
    flow = np.clip(0.6 + 0.2 * tooth / tooth.std(), 0.1, 1)
    soft = cv2.GaussianBlur(np.maximum(hatching, outline) * flow, (0, 0), 1.0)
    grain = rng.normal(0, 0.01, soft.shape)
    ink = flatten_paper((tone * (1 - soft) + grain).astype(np.float32))
    assert (ink[(hatching > 0.9) & (flow > 0.5)] > 0.3).mean() > 0.98
    assert (ink[cv2.dilate(soft, np.ones((9, 9))) < 0.02] > 0.2).mean() < 1e-3


def test_specks_do_not_pass_for_the_pen():
    line = 255.0 - drawn((400, 600), 2, [[30, 200], [570, 260]])
    rng = np.random.default_rng(3)
    specks = cv2.GaussianBlur((rng.random(line.shape) < 0.01).astype(np.float32), (0, 0), 1.0)
    gray = 0.9 - 0.4 * line / 255 - 0.5 * np.minimum(specks, 0.2)
    ink = flatten_paper(gray.astype(np.float32))
    assert np.median(ink[line > 250]) > 0.8
    assert np.quantile(ink[cv2.dilate(line, np.ones((15, 15))) == 0], 0.995) < 0.3


def test_a_stain_beside_a_pen_is_paper():
    line = 255.0 - drawn((400, 600), 4, [[30, 50], [570, 60]])
    y = np.arange(400)[:, None] - 300 - 8 * np.sin(np.arange(600) / 40)
    crease = 0.06 * np.exp(-((y / 4) ** 2))
    ink = flatten_paper((0.95 * (1 - 0.9 * line / 255) - crease).astype(np.float32))
    assert ink[250:].max() < 0.05


def test_faint_pencil_beside_ink_stays_visible():
    dark = drawn((400, 600), 4, [[30, 50], [570, 60]])
    faint = drawn((400, 600), 4, [[30, 300], [570, 320]])
    ink = ink_of(with_noise(250 - 0.95 * (255 - dark) - 0.14 * (255 - faint.astype(float)), 3))
    assert ink[308:312, 300].max() > 0.25
    assert ink[54:57, 300].max() > 0.9


def test_solid_black_stays_ink():
    picture = page(640, 480)
    cv2.ellipse(picture, (450, 330), (120, 90), 20, 0, 360, 0, -1)
    ink = ink_of(picture)
    assert ink[330, 450] > 0.95


def test_blank_pages_have_no_ink():
    for blank in (
        np.full((100, 120), 255, np.uint8),
        np.full((100, 120), 140, np.uint8),
        with_noise(np.full((300, 300), 230.0), 6),
    ):
        assert ink_of(blank).max() < 0.6
        assert (ink_of(blank) > 0.2).mean() < 1e-3


# --- scale -----------------------------------------------------------------------------------


@pytest.mark.parametrize(("pen", "low", "high"), [(1, 0.8, 1.6), (3, 2.5, 3.5), (7, 6.3, 7.7)])
def test_pen_is_measured(pen, low, high):
    assert low <= measure_pen(flatten_paper(page(pen=pen) / np.float32(255))) <= high


@pytest.mark.parametrize("pen", [1, 5, 30])
def test_pens_are_2_to_8_px_where_the_work_is_done(pen):
    scan = read_scan(page(1200, 900, pen), SETTINGS)
    assert 1.5 <= scan.pen_width <= 8.0
    assert scan.pen_width * scan.scale == pytest.approx(pen, rel=0.15, abs=0.5)


def test_large_pages_with_fat_pens_are_worked_smaller():
    picture = cv2.resize(page(800, 600, 2), None, fx=5, fy=5, interpolation=cv2.INTER_CUBIC)
    scan = read_scan(picture, SETTINGS)
    assert scan.ink.size < 5e6
    assert scan.pen_width > 3.5


def test_places_scale_back_to_input_pixels():
    spots = [(1450, 200), (200, 1050)]
    crosses = [[[x - 60, y], [x + 60, y]] for x, y in spots]
    crosses += [[[x, y - 60], [x, y + 60]] for x, y in spots]
    picture = drawn((1200, 1600), 20, [[100, 100], [1500, 1100]], *crosses)
    scan = read_scan(picture, SETTINGS)
    assert scan.scale > 2
    for x, y in spots:
        top, left = int((y - 90) / scan.scale), int((x - 90) / scan.scale)
        window = scan.ink[top : top + int(180 / scan.scale), left : left + int(180 / scan.scale)]
        rows, columns = np.indices(window.shape)
        middle_x = ((columns + left + 0.5) * window).sum() / window.sum() * scan.scale
        middle_y = ((rows + top + 0.5) * window).sum() / window.sum() * scan.scale
        assert abs(middle_x - x) < 0.3
        assert abs(middle_y - y) < 0.3


def test_the_pen_can_be_told():
    assert read_scan(page(), Settings(pen_width=12)).scale == pytest.approx(2.0, rel=0.4)


def test_dots_do_not_count_as_a_pen():
    picture = page(1600, 1200, 3)
    for x in range(100, 1500, 40):
        cv2.circle(picture, (x, 1000), 12, 0, -1)
    assert read_scan(picture, SETTINGS).pen_width < 5


@given(
    hnp.arrays(
        np.uint8, st.tuples(st.integers(16, 70), st.integers(16, 70)), elements=st.integers(30, 255)
    )
)
@settings(max_examples=30, deadline=None)
def test_any_small_picture_gives_ink(picture):
    scan = read_scan(picture, SETTINGS)
    assert np.isfinite(scan.ink).all()
    assert scan.ink.min() >= 0
    assert scan.ink.max() <= 1
    assert abs(scan.ink.shape[1] * scan.scale - scan.size[0]) <= 1


def test_flattening_twice_gives_the_same():
    gray = with_noise(page(), 6) / np.float32(255)
    np.testing.assert_array_equal(flatten_paper(gray), flatten_paper(gray.copy()))


# --- what can't be read ----------------------------------------------------------------------


def jpeg(size: int = 200) -> bytes:
    noise = np.random.default_rng(0).integers(0, 255, (size, size), np.uint8)
    return cv2.imencode(".jpg", noise)[1].tobytes()


@pytest.mark.parametrize(
    ("name", "content", "says"),
    [
        ("text.png", b"not a picture at all", "not a picture"),
        ("empty.png", b"", "not a picture"),
        ("cut.jpg", jpeg()[:-200], "damaged"),
        ("cut.tif", tiff([page()])[:5000], "damaged"),
        ("dot.png", cv2.imencode(".png", np.zeros((1, 1), np.uint8))[1].tobytes(), "1 x 1 px"),
        ("thin.png", cv2.imencode(".png", np.zeros((15, 99), np.uint8))[1].tobytes(), "99 x 15 px"),
        ("long.png", cv2.imencode(".png", np.zeros((16, 20001), np.uint8))[1].tobytes(), "20,000"),
        ("huge.png", None, "too large"),
        ("black.png", cv2.imencode(".png", np.zeros((99, 99), np.uint8))[1].tobytes(), "black all"),
    ],
)
def test_bad_files_are_refused_with_a_sentence(name, content, says, tmp_path, capfd):
    if content is None:  # only the header of a PNG of 40,000 x 40,000 px
        small = cv2.imencode(".png", np.zeros((16, 16), np.uint8))[1].tobytes()
        header = b"IHDR" + struct.pack(">II", 40_000, 40_000) + small[24:29]
        checksum = struct.pack(">I", __import__("zlib").crc32(header))
        content = small[:12] + header + checksum + small[33:]
    (tmp_path / name).write_bytes(content)
    with pytest.raises(InvoluteError, match=says) as error:
        read_scan(tmp_path / name, SETTINGS)
    sentence = str(error.value)
    assert sentence.endswith(".")
    assert "\n" not in sentence
    assert "[" not in capfd.readouterr().err  # OpenCV keeps quiet


def test_missing_files_and_folders_are_named(tmp_path):
    for read in (lambda path: read_scan(path, SETTINGS), page_count):
        with pytest.raises(InvoluteError, match=r"no file .*gone\.png"):
            read(tmp_path / "gone.png")
        with pytest.raises(InvoluteError, match="is a folder"):
            read(tmp_path)


@pytest.mark.parametrize(
    ("array", "says"),
    [
        (np.full((50, 50), np.nan, np.float32), "NaN"),
        (np.full((50, 50), 200.0), "outside 0 to 1"),
        (np.zeros((50, 50), np.int64), "int64"),
        (np.zeros((50, 50), complex), "complex"),
        (np.zeros(50, np.uint8), "shape"),
        (np.zeros((50, 50, 2), np.uint8), "shape"),
        (np.zeros((0, 50), np.uint8), "50 x 0 px"),
        (np.zeros((50, 50), np.uint8), "black all over"),
    ],
)
def test_bad_arrays_are_refused_with_a_sentence(array, says):
    with pytest.raises(InvoluteError, match=says):
        read_scan(array, SETTINGS)
