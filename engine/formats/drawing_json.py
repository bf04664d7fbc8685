"""A whole drawing as JSON: graph, routing, strokes, fills and settings; loses nothing.

Arrays are compressed raw bytes (zlib, base64), so that a page of 10,000 strokes is a few MB and
opens at once; everything else is plain JSON. `dumps` and `loads` also serve what keeps a drawing
inside another file.
"""

from __future__ import annotations

import base64
import binascii
import json
import zlib
from collections.abc import Sequence
from dataclasses import fields
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np

from ..drawing import Drawing
from ..errors import InvoluteError
from ..fidelity import Fidelity
from ..settings import Settings
from ..values import Alternative, Array, PlanarGraph, Routing, Stroke
from .whole_file import write_text

FORMAT, VERSION = "involute drawing", 1
_DTYPES = ("float32", "int32", "uint8", "bool")


def write(drawing: Drawing, path: Path) -> None:
    """Write a drawing to a JSON file."""
    write_text(dumps(drawing), path)


def dumps(drawing: Drawing) -> str:
    """The drawing as JSON text."""
    routing, strokes = drawing.routing, drawing.strokes
    rings = [ring for fill in drawing.fills for ring in fill]
    document = {
        "format": FORMAT,
        "version": VERSION,
        "size": list(drawing.size),
        "scale": drawing.scale,
        "settings": drawing.settings.as_dict(),
        "seconds": dict(drawing.seconds),
        "graph": {f.name: _packed(getattr(drawing.graph, f.name)) for f in fields(PlanarGraph)},
        "routing": {
            "partner": _packed(routing.partner),
            "pairs": _packed(routing.pairs),
            "pair_score": _packed(routing.pair_score),
            "locked": _packed(routing.locked),
            "alternatives": [
                [[a.pairs, a.probability] for a in ways] for ways in routing.alternatives
            ],
        },
        "strokes": {
            "points": _joined([s.points for s in strokes], (0, 2)),
            "offsets": _packed(_offsets([len(s.points) for s in strokes])),
            "widths": _joined([s.widths for s in strokes], (0,)),
            "opacity": _joined([s.opacity for s in strokes], (0,)),
            "closed": _packed(np.array([s.closed for s in strokes], bool)),
            "color": _packed(np.array([s.color for s in strokes], np.uint8).reshape(-1, 3)),
            "branches": _joined([s.branches for s in strokes], (0,), np.int32),
            "branch_offsets": _packed(_offsets([len(s.branches) for s in strokes])),
            "curved": _packed(np.array([s.handles is not None for s in strokes], bool)),
            "handles": _joined([s.handles for s in strokes if s.handles is not None], (0, 2, 2)),
        },
        "fills": {
            "points": _joined(rings, (0, 2)),
            "offsets": _packed(_offsets([len(ring) for ring in rings])),
            "ring_offsets": _packed(_offsets([len(fill) for fill in drawing.fills])),
        },
        "region_colors": _packed(drawing.region_colors),
        "fidelity": drawing.fidelity and drawing.fidelity.as_dict(),
        "notes": list(drawing.notes),
        "warnings": list(drawing.warnings),
    }
    return json.dumps(document, separators=(",", ":"))


def read(text: str, name: str = "The file") -> Drawing:
    """The drawing that `dumps` wrote.

    Args:
        text: the JSON.
        name: what to call it in an error.

    Raises:
        InvoluteError: not a drawing, a damaged one, or one of a newer version.
    """
    try:
        document = json.loads(text)
        if document.get("format") != FORMAT:
            raise ValueError("another format")
        if document["version"] > VERSION:
            raise InvoluteError(
                f"{name} was written by a newer Involute (format {document['version']}, this one "
                f"reads up to {VERSION}); update Involute to open it."
            )
        return _drawing(document)
    except (AttributeError, IndexError, KeyError, TypeError, ValueError, zlib.error) as error:
        raise InvoluteError(
            f"{name} isn't a drawing of Involute or is damaged; trace the picture again."
        ) from error


def _drawing(document: dict[str, Any]) -> Drawing:
    known = {f.name for f in fields(Settings)}
    graph = PlanarGraph(**{k: _unpacked(v) for k, v in document["graph"].items()})
    routing = document["routing"]
    alternatives = tuple(
        tuple(Alternative(tuple((a, b) for a, b in pairs), p) for pairs, p in ways)
        for ways in routing.pop("alternatives")
    )
    drawing = Drawing(
        graph=graph,
        routing=Routing(**{k: _unpacked(v) for k, v in routing.items()}, alternatives=alternatives),
        strokes=tuple(_strokes(document["strokes"])),
        fills=tuple(_fills(document["fills"])),
        size=(int(document["size"][0]), int(document["size"][1])),
        settings=Settings(**{k: v for k, v in document["settings"].items() if k in known}),
        seconds=document["seconds"],
        scale=float(document.get("scale", 1.0)),
        region_colors=_unpacked(document.get("region_colors")),
        fidelity=Fidelity.from_dict(document["fidelity"]) if document.get("fidelity") else None,
        notes=tuple(map(str, document.get("notes", ()))),
        warnings=tuple(map(str, document.get("warnings", ()))),
    )
    _check(drawing)
    return drawing


def _check(drawing: Drawing) -> None:
    """Refuse what would only fail later, somewhere else."""
    graph, routing = drawing.graph, drawing.routing
    halves = 2 * graph.branch_count
    partner = routing.partner
    sound = (
        len(graph.ends) == graph.branch_count
        and graph.offsets[-1] == len(graph.points)
        and (halves == 0 or 0 <= graph.ends.min() <= graph.ends.max() < len(graph.vertices))
        and len(partner) == halves
        and np.array_equal(partner[partner], np.arange(halves))
        and len(routing.alternatives) == len(routing.locked) == len(graph.junctions)
    )
    if not sound:
        raise ValueError("graph and routing don't fit")


def _strokes(packed: dict[str, Any]) -> list[Stroke]:
    data = {name: _unpacked(value) for name, value in packed.items()}
    starts, first = data["offsets"], data["branch_offsets"]
    curve = _offsets(np.diff(starts) * data["curved"])
    return [
        Stroke(
            points=data["points"][low:high],
            widths=data["widths"][low:high],
            opacity=data["opacity"][low:high],
            closed=closed,
            color=tuple(color),
            branches=data["branches"][first[i] : first[i + 1]],
            handles=data["handles"][curve[i] : curve[i + 1]] if curved else None,
        )
        for i, (low, high, closed, color, curved) in enumerate(
            zip(
                starts[:-1].tolist(),
                starts[1:].tolist(),
                data["closed"].tolist(),
                data["color"].tolist(),
                data["curved"].tolist(),
                strict=True,
            )
        )
    ]


def _fills(packed: dict[str, Any]) -> list[tuple[Array, ...]]:
    points, offsets, ring_offsets = (
        _unpacked(packed[name]) for name in ("points", "offsets", "ring_offsets")
    )
    rings = np.split(points, offsets[1:-1]) if len(offsets) > 1 else []
    return [tuple(rings[a:b]) for a, b in pairwise(ring_offsets)]


def _offsets(counts: Sequence[int] | Array) -> Array:
    return np.concatenate([[0], np.cumsum(counts)]).astype(np.int32)


def _joined(parts: list[Array], empty: tuple[int, ...], dtype: type = np.float32) -> Any:
    return _packed(np.concatenate(parts).astype(dtype) if parts else np.zeros(empty, dtype))


def _packed(array: Array | None) -> Any:
    if array is None:
        return None
    kind = {"f": "float32", "i": "int32", "u": "uint8", "b": "bool"}[array.dtype.kind]
    raw = np.ascontiguousarray(array, kind).tobytes()
    data = base64.b64encode(zlib.compress(raw, 6)).decode("ascii")
    return {"dtype": kind, "shape": list(array.shape), "data": data}


def _unpacked(packed: Any) -> Array | None:
    if packed is None:
        return None
    if packed["dtype"] not in _DTYPES:
        raise ValueError("an unknown kind of array")
    try:
        raw = zlib.decompress(base64.b64decode(packed["data"], validate=True))
    except binascii.Error as error:
        raise ValueError("damaged array") from error
    return np.frombuffer(raw, packed["dtype"]).reshape(packed["shape"]).copy()
