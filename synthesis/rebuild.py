"""Build the drawings for training from their public packages.

    python -m involute.synthesis.rebuild --out DATA [--only openmoji kanjivg]

Writes NAME.npz and NAME.json (source, licence, attribution, names) for each set. Needs npm for the
npm packages and apt-get with dpkg-deb for the Debian one. The same packages give the same files.
Quick, Draw! and the Excalidraw libraries are in no package and are not rebuilt here.
"""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
import tarfile
import zipfile
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import reduce
from pathlib import Path
from tempfile import TemporaryDirectory
from xml.etree import ElementTree

import numpy as np
import shapely

from .artwork import Array, Shape, read_svg

BOX = 1024  # px; the longer side of a drawing
SCALE = 32  # steps per px in the file
TOLERANCE = 0.3  # px of a box; curves are flattened finer than what anyone can see
_SHORTEST = 3.0  # px; what is left of a stroke behind a fill and is shorter is dropped
_NOTHING = shapely.Polygon()
_OPEN_CLIPART = Path(__file__).with_name("openclipart.txt")


@dataclass(frozen=True)
class Source:
    """A set of drawings: where it comes from, and which of its documents count.

    documents: yields (name, SVG) from the folder that the package was unpacked in.
    strokes: least and greatest number of strokes. count: how many are drawn, preferring complex
    ones; None = all.
    """

    package: str
    licence: str
    attribution: str
    documents: Callable[[Path], Iterator[tuple[str, str]]]
    strokes: tuple[int, int] = (2, 700)
    count: int | None = None


def _iconify(counts: dict[str, int]) -> Callable[[Path], Iterator[tuple[str, str]]]:
    """Icons of several sets of @iconify/json, at most so many of each, complex ones first."""

    def documents(folder: Path) -> Iterator[tuple[str, str]]:
        rng = np.random.default_rng(1)
        for prefix, count in counts.items():
            data = json.loads((folder / f"package/json/{prefix}.json").read_text())
            names = [n for n, icon in data["icons"].items() if "stroke" in icon["body"]]
            # The length of an icon's text tells its complexity well enough.
            size = np.array([min(4000, len(data["icons"][n]["body"])) for n in names], float)
            picked = rng.choice(len(names), min(count, len(names)), False, size / size.sum())
            for k in picked:
                icon = data["icons"][names[k]]
                width = icon.get("width", data.get("width", 16))
                height = icon.get("height", data.get("height", 16))
                yield (
                    f"{prefix}:{names[k]}",
                    '<svg xmlns="http://www.w3.org/2000/svg" '
                    'xmlns:xlink="http://www.w3.org/1999/xlink" '
                    f'viewBox="0 0 {width} {height}">{icon["body"]}</svg>',
                )

    return documents


def _openmoji(folder: Path) -> Iterator[tuple[str, str]]:
    listed = json.loads((folder / "package/data/openmoji.json").read_text())
    for entry in listed:
        plain = not entry.get("skintone") and entry["group"] not in ("flags", "extras-flags")
        if plain and "brand" not in entry.get("subgroups", ""):
            path = folder / f"package/black/svg/{entry['hexcode']}.svg"
            if path.exists():
                yield f"{entry['hexcode']} {entry['annotation']}", path.read_text()


def _kanjivg(folder: Path) -> Iterator[tuple[str, str]]:
    for path in sorted(folder.glob("kanji/*.svg")):
        code = path.stem
        if len(code) == 5 and 0x4E00 <= int(code, 16) < 0xA000:
            # The document type declares entities and attributes that we have no use for.
            text = path.read_text()
            yield chr(int(code, 16)), text[text.index("<svg") :].replace("kvg:", "kvg_")


def _openclipart(folder: Path) -> Iterator[tuple[str, str]]:
    """Drawings made of strokes; a fixed list, since others serve as benchmark."""
    for name in _OPEN_CLIPART.read_text().split():
        path = folder / "usr/share/openclipart/svg" / name
        if path.exists():
            yield name, path.read_text(errors="replace")


SOURCES = {
    "openmoji": Source(
        "npm openmoji@17.0.0",
        "CC-BY-SA-4.0",
        "OpenMoji, the open-source emoji and icon project, https://openmoji.org",
        _openmoji,
    ),
    "streamline": Source(
        "npm @iconify/json@2.2.535",
        "CC-BY-4.0 (meteocons MIT)",
        "Streamline, https://streamlinehq.com; Meteocons by Bas Milius",
        _iconify(
            {
                "streamline-emojis": 700,
                "streamline-stickies-color": 200,
                "streamline-ultimate-color": 400,
                "meteocons": 50,
            }
        ),
        (3, 700),
    ),
    "arcticons": Source(
        "npm @iconify/json@2.2.535",
        "CC-BY-SA-4.0",
        "Donnnno and the Arcticons team",
        _iconify({"arcticons": 2500}),
        (3, 300),
    ),
    "icons_permissive": Source(
        "npm @iconify/json@2.2.535",
        "MIT, ISC, Apache-2.0, CC-BY-4.0",
        "Lucide, Tabler, Iconoir, Huge Icons, IconPark, Icon Mind, Covid, Keyline, Vadivam, "
        "Marketeq, Grommet and their contributors",
        _iconify(
            {
                "lucide": 700,
                "lucide-lab": 250,
                "tabler": 800,
                "iconoir": 400,
                "hugeicons": 1000,
                "icon-park-outline": 900,
                "iconmind": 900,
                "covid": 150,
                "keyline-icons": 500,
                "vadivam": 300,
                "marketeq": 300,
                "grommet-icons": 250,
            }
        ),
        (3, 300),
    ),
    "kanjivg": Source(
        "pypi kanjivg",
        "CC-BY-SA-3.0",
        "Ulrich Apel and the KanjiVG project, http://kanjivg.tagaini.net",
        _kanjivg,
        (8, 60),
        1500,
    ),
    "openclipart": Source(
        "debian openclipart-svg",
        "Public domain dedication",
        "Open Clip Art Library contributors",
        _openclipart,
        (3, 3000),
    ),
}


def main(arguments: list[str] | None = None) -> None:
    """The command line."""
    parser = argparse.ArgumentParser(prog="rebuild", description=__doc__.splitlines()[0])
    parser.add_argument("--out", type=Path, required=True)
    parser.add_argument("--only", nargs="+", choices=list(SOURCES), default=list(SOURCES))
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args(arguments)
    options.out.mkdir(parents=True, exist_ok=True)
    with TemporaryDirectory() as temporary:
        unpacked: dict[str, Path] = {}
        for name in options.only:
            source = SOURCES[name]
            if source.package not in unpacked:
                unpacked[source.package] = fetch(source.package, Path(temporary))
            drawings = collect(source, unpacked[source.package], options.seed)
            write(options.out / f"{name}.npz", source, drawings)
            strokes = sum(len(d) for d in drawings.values())
            print(f"{name}: {len(drawings)} drawings, {strokes} strokes")


def fetch(package: str, folder: Path) -> Path:
    """Download and unpack a package ("npm NAME@VERSION", "pypi NAME", "debian NAME").

    Raises:
        subprocess.CalledProcessError: it can't be had.
    """
    kind, name = package.split()
    into = folder / package.replace("/", "_").replace(" ", "_")
    into.mkdir()
    command = {
        "npm": ["npm", "pack", "--silent", name],
        "pypi": [sys.executable, "-m", "pip", "download", "--quiet", "--no-deps", name],
        "debian": ["apt-get", "download", name],
    }[kind]
    subprocess.run(command, cwd=into, check=True, stdout=subprocess.DEVNULL)
    (archive,) = into.iterdir()
    if archive.suffix == ".tgz":
        with tarfile.open(archive) as tar:
            tar.extractall(into, filter="data")
    elif archive.suffix == ".whl":
        with zipfile.ZipFile(archive) as wheel:
            wheel.extractall(into)
    else:
        subprocess.run(["dpkg-deb", "-x", str(archive), str(into)], check=True)
    return into


def collect(source: Source, folder: Path, seed: int) -> dict[str, list[Array]]:
    """The drawings of a set by name, in the box; documents that can't be read are left out."""
    drawings = {}
    for name, text in source.documents(folder):
        try:
            strokes = drawing(text)
        except (ElementTree.ParseError, ValueError, shapely.errors.GEOSException):
            continue
        if source.strokes[0] <= len(strokes) <= source.strokes[1]:
            drawings[name] = strokes
    if source.count is None or len(drawings) <= source.count:
        return drawings
    names = list(drawings)
    size = np.array([min(40, len(drawings[n])) for n in names], float)
    rng = np.random.default_rng(seed)
    picked = rng.choice(len(names), source.count, False, size / size.sum())
    return {names[k]: drawings[names[k]] for k in sorted(picked)}


def drawing(text: str) -> list[Array]:
    """The visible strokes of a document as (N, 2) polylines in a 0..BOX box."""
    rough = read_svg(text, 1e9)
    points = [p for shape in rough if shape.width for p in shape.subpaths]
    if not points:
        return []
    low, high = np.concatenate(points).min(0), np.concatenate(points).max(0)
    scale = BOX / max(1e-9, float((high - low).max()))
    shapes = read_svg(text, TOLERANCE / scale)
    points = np.concatenate([p for shape in shapes if shape.width for p in shape.subpaths])
    low, high = points.min(0), points.max(0)
    scale = BOX / max(1e-9, float((high - low).max()))
    shift = (BOX - (low + high) * scale) / 2
    return visible([_moved(shape, scale, shift) for shape in shapes])


def _moved(shape: Shape, scale: float, shift: Array) -> Shape:
    return Shape([p * scale + shift for p in shape.subpaths], shape.width * scale, shape.fill)


def visible(shapes: list[Shape]) -> list[Array]:
    """What later fills leave of the strokes, in painting order."""
    lines: list[shapely.Geometry] = []
    for shape in shapes:
        if shape.fill is not None and lines:
            rings = [shapely.Polygon(p) for p in shape.subpaths if len(p) > 3]
            cover = reduce(shapely.symmetric_difference, map(shapely.make_valid, rings), _NOTHING)
            # A fill that only borders on a line does not hide it.
            cover = shapely.buffer(cover, -1.0)
            if not cover.is_empty:
                hit = shapely.intersects(lines, cover)
                lines = [
                    shapely.difference(line, cover) if h else line
                    for line, h in zip(lines, hit, strict=True)
                ]
        if shape.width:
            lines += [shapely.LineString(p) for p in shape.subpaths]
    pieces = []
    for line in lines:
        # A ring that is cut somewhere must not break at its first point as well.
        whole = shapely.line_merge(line) if line.geom_type == "MultiLineString" else line
        pieces += [p for p in shapely.get_parts(whole) if p.length >= _SHORTEST]
    return [shapely.get_coordinates(p).astype(np.float32) for p in pieces]


def write(path: Path, source: Source, drawings: dict[str, list[Array]]) -> None:
    """Pack drawings as `Library.load` reads them, and their origin as JSON beside."""
    strokes = [s for d in drawings.values() for s in d]
    points = np.concatenate(strokes) if strokes else np.zeros((0, 2), np.float32)
    np.savez_compressed(
        path,
        points=np.round(np.clip(points, 0, BOX) * SCALE).astype(np.uint16),
        scale=np.float32(1 / SCALE),
        stroke_offsets=np.cumsum([0] + [len(s) for s in strokes]).astype(np.int32),
        drawing_offsets=np.cumsum([0] + [len(d) for d in drawings.values()]).astype(np.int32),
    )
    origin = {
        "origin": source.package,
        "licence": source.licence,
        "attribution": source.attribution,
        "drawings": len(drawings),
        "strokes": len(strokes),
        "names": list(drawings),
    }
    path.with_suffix(".json").write_text(json.dumps(origin, ensure_ascii=False, indent=0))


if __name__ == "__main__":
    main()
