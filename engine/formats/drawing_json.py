"""A whole drawing as JSON: graph, routing, strokes, fills and settings; loses nothing.

Arrays are compressed raw bytes (zlib, base64), so that a page of 10,000 strokes is a few MB and
opens at once; everything else is plain JSON. `dumps` and `loads` also serve what keeps a drawing
inside another file.
"""

from __future__ import annotations

import base64
import binascii
import json
import math
import zlib
from collections.abc import Callable, Sequence
from dataclasses import fields, replace
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np

from ..drawing import Drawing
from ..errors import InvoluteError
from ..fidelity import Fidelity
from ..routing import with_corners
from ..settings import Settings
from ..soundness import UnsoundError, check_drawing, check_graph
from ..values import (
    Alternative,
    Answers,
    Array,
    Beside,
    Pencil,
    PlanarGraph,
    Routing,
    Stroke,
)
from .whole_file import write_text

FORMAT, VERSION = "involute drawing", 1
_DTYPES = ("float32", "int32", "uint8", "bool")
_MOST_BYTES = 2**29  # of all tables of a drawing; a page of 8192 px has some 2**25


def write(drawing: Drawing, path: Path) -> None:
    """Write a drawing to a JSON file."""
    write_text(dumps(drawing), path)


def dumps(drawing: Drawing) -> str:
    """The drawing as JSON text."""
    routing, pencil = drawing.routing, drawing.pencil
    rings = [ring for fill in drawing.fills for ring in fill]
    document = {
        "format": FORMAT,
        "version": VERSION,
        "size": list(drawing.size),
        "scale": drawing.scale,
        "dpi": drawing.dpi,
        "settings": drawing.settings.as_dict(),
        "seconds": dict(drawing.seconds),
        "graph": _graph_tables(drawing.graph),
        "routing": {
            "partner": _packed(routing.partner),
            "pairs": _packed(routing.pairs),
            "pair_score": _packed(routing.pair_score),
            "locked": _packed(routing.locked),
            "alternatives": [
                [[a.pairs, a.probability] for a in ways] for ways in routing.alternatives
            ],
        },
        "strokes": _stroke_tables(drawing.strokes),
        "fills": {
            "points": _joined(rings, (0, 2)),
            "offsets": _packed(_offsets([len(ring) for ring in rings])),
            "ring_offsets": _packed(_offsets([len(fill) for fill in drawing.fills])),
        },
        "region_colors": _packed(drawing.region_colors),
        "fidelity": drawing.fidelity and drawing.fidelity.as_dict(),
        "notes": list(drawing.notes),
        "warnings": list(drawing.warnings),
        "pencil": pencil and _pencil_tables(pencil),
    }
    return json.dumps(document, separators=(",", ":"))


def _pencil_tables(pencil: Pencil) -> dict[str, Any]:
    tables = {**_stroke_tables(pencil.strokes), "said": _packed(pencil.said)}
    if pencil.beside is not None:
        kept = pencil.beside
        tables["beside"] = {"graph": _graph_tables(kept.graph), **_tables_of(kept, "graph")}
    if len(pencil.answers.one):
        tables["answers"] = _tables_of(pencil.answers)
    return tables


def _tables_of(value: Beside | Answers, but: str = "") -> dict[str, Any]:
    return {f.name: _packed(getattr(value, f.name)) for f in fields(value) if f.name != but}


def _graph_tables(graph: PlanarGraph) -> dict[str, Any]:
    tables = {f.name: _packed(getattr(graph, f.name)) for f in fields(PlanarGraph)}
    if graph.bare is None:  # older programs don't know it
        del tables["bare"]
    return tables


def _stroke_tables(strokes: Sequence[Stroke]) -> dict[str, Any]:
    dashed = [s.dash or (0.0, 0.0) for s in strokes]
    dash = {"dash": _packed(np.array(dashed, np.float32))} if any(map(any, dashed)) else {}
    return {
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
        **dash,
    }


def read(text: str, name: str = "The file") -> Drawing:
    """The drawing that `dumps` wrote; checked completely, see `soundness`.

    Args:
        text: the JSON.
        name: what to call it in an error.

    Raises:
        InvoluteError: not a drawing, a damaged one, or one of a newer version.
    """
    try:
        document = json.loads(text, parse_constant=_no_constant)
        _check_head(document, name)
        drawing = _drawing(document)
        check_graph(drawing.graph)
        drawing = replace(drawing, routing=with_corners(drawing.routing, drawing.graph))
        check_drawing(drawing)
        return drawing
    except UnsoundError as error:
        raise _damaged(name, str(error)) from error
    except json.JSONDecodeError as error:
        raise _damaged(name, f"line {error.lineno}, column {error.colno}: {error.msg}") from error
    except (ArithmeticError, AttributeError, LookupError, RecursionError, TypeError) as error:
        raise _damaged(name, "it is not laid out as one") from error
    except ValueError as error:
        raise _damaged(name, "it is not laid out as one") from error


def _damaged(name: str, why: str) -> InvoluteError:
    return InvoluteError(
        f"{name} isn't a drawing of Involute or is damaged ({why}); trace the picture again."
    )


def _no_constant(word: str) -> float:
    raise UnsoundError(f"{word} stands in it")


def _check_head(document: Any, name: str) -> None:
    """Refuse what says itself that it is something else.

    Raises:
        UnsoundError, InvoluteError: says what.
    """
    if not isinstance(document, dict) or document.get("format") != FORMAT:
        raise UnsoundError("it does not say that it is one")
    version = document.get("version")
    if type(version) is not int or version < 1:
        raise UnsoundError("its version is no number")
    if version > VERSION:
        raise InvoluteError(
            f"{name} was written by a newer Involute (format {str(version)[:9]}, this one "
            f"reads up to {VERSION}); update Involute to open it."
        )


def _drawing(document: dict[str, Any]) -> Drawing:
    known = {f.name for f in fields(Settings)}
    unpack = _Unpacker()
    width, height = document["size"]
    if type(width) is not int or type(height) is not int:
        raise UnsoundError("its size is no number of pixels")
    try:
        settings = Settings(**{k: v for k, v in document["settings"].items() if k in known})
    except InvoluteError as error:
        raise UnsoundError(str(error).rstrip(".")) from None

    def tables(part: dict[str, Any]) -> dict[str, Any]:
        return {name: unpack(packed) for name, packed in part.items()}

    routing = dict(document["routing"])
    alternatives = tuple(
        tuple(Alternative(tuple((a, b) for a, b in pairs), p) for pairs, p in ways)
        for ways in routing.pop("alternatives")
    )
    return Drawing(
        graph=PlanarGraph(**tables(document["graph"])),
        routing=Routing(**tables(routing), alternatives=alternatives),
        strokes=tuple(_strokes(tables(document["strokes"]))),
        fills=tuple(_fills(tables(document["fills"]))),
        size=(width, height),
        settings=settings,
        seconds=dict(document["seconds"]),
        scale=float(document.get("scale", 1.0)),
        dpi=None if document.get("dpi") is None else float(document["dpi"]),
        region_colors=unpack(document.get("region_colors")),
        fidelity=Fidelity.from_dict(document["fidelity"]) if document.get("fidelity") else None,
        notes=tuple(map(str, document.get("notes", ()))),
        warnings=tuple(map(str, document.get("warnings", ()))),
        pencil=_pencil(document["pencil"], tables) if document.get("pencil") else None,
    )


def _pencil(part: dict[str, Any], tables: Callable[[dict[str, Any]], dict[str, Any]]) -> Pencil:
    part = dict(part)
    kept, answers = part.pop("beside", None), part.pop("answers", None)
    beside = None
    if kept:
        graph = PlanarGraph(**tables(kept["graph"]))
        beside = Beside(graph, **tables({k: v for k, v in kept.items() if k != "graph"}))
    data = tables(part)
    said = data.pop("said")
    given = Answers(**tables(answers)) if answers else Answers.none()
    return Pencil(tuple(_strokes(data)), said, beside, given)


def _strokes(data: dict[str, Array]) -> list[Stroke]:
    count = len(data["closed"])
    starts = _starts(data["offsets"], count, len(data["points"]), "the points of the strokes")
    first = _starts(data["branch_offsets"], count, len(data["branches"]), "the strokes' branches")
    dash = data.get("dash", np.zeros((count, 2), np.float32))
    tables = {"closed": (count,), "curved": (count,), "color": (count, 3)}
    for name, shape in tables.items():
        if data[name].shape != shape:
            raise UnsoundError(f"the table '{name}' of the strokes has not their number")
    if dash.shape != (count, 2) or not (np.isfinite(dash) & (dash >= 0)).all():
        raise UnsoundError("the dashes of the strokes are no lengths")
    curve = _offsets(np.diff(starts) * data["curved"].astype(bool)).tolist()
    _starts(curve, count, len(data["handles"]), "the handles of the strokes")
    return [
        Stroke(
            points=data["points"][low:high],
            widths=data["widths"][low:high],
            opacity=data["opacity"][low:high],
            closed=closed,
            color=tuple(color),
            branches=data["branches"][first[i] : first[i + 1]],
            handles=data["handles"][curve[i] : curve[i + 1]] if curved else None,
            dash=(mark, gap) if gap else None,
        )
        for i, (low, high, closed, color, curved, (mark, gap)) in enumerate(
            zip(
                starts[:-1],
                starts[1:],
                data["closed"].astype(bool).tolist(),
                data["color"].tolist(),
                data["curved"].astype(bool).tolist(),
                dash.tolist(),
                strict=True,
            )
        )
    ]


def _fills(data: dict[str, Array]) -> list[tuple[Array, ...]]:
    points, offsets = data["points"], data["offsets"]
    starts = _starts(offsets, len(offsets) - 1, len(points), "the outlines of the fills")
    rings = [points[low:high] for low, high in pairwise(starts)]
    of_fill = data["ring_offsets"]
    return [
        tuple(rings[low:high])
        for low, high in pairwise(_starts(of_fill, len(of_fill) - 1, len(rings), "the fills"))
    ]


def _starts(offsets: Array | list[int], count: int, total: int, what: str) -> list[int]:
    """Where each of so many rows begins in a table of so many, and the end of the last.

    Raises:
        UnsoundError: they don't fit.
    """
    values = np.asarray(offsets)
    good = values.ndim == 1 and values.dtype.kind == "i" and len(values) == count + 1
    good = good and values[0] == 0 and values[-1] == total and bool((np.diff(values) >= 0).all())
    if not good:
        raise UnsoundError(f"{what} don't fit together")
    return values.tolist()


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


class _Unpacker:
    """Unpacks the arrays of one drawing; never more than what they say, and not too much of it."""

    def __init__(self) -> None:
        self._left = _MOST_BYTES

    def __call__(self, packed: Any) -> Array | None:
        if packed is None:
            return None
        dtype, shape = packed["dtype"], packed["shape"]
        if dtype not in _DTYPES or any(type(n) is not int or n < 0 for n in shape):
            raise UnsoundError("a table of an unknown kind is in it")
        size = math.prod(shape) * np.dtype(dtype).itemsize
        self._left -= size
        if self._left < 0 or len(shape) > 3:
            raise UnsoundError("its tables are larger than those of any page")
        try:
            raw = base64.b64decode(packed["data"], validate=True)
            unpacker = zlib.decompressobj()
            content = unpacker.decompress(raw, size + 1)
        except (binascii.Error, zlib.error):
            raise UnsoundError("a table in it is damaged") from None
        if len(content) != size:
            raise UnsoundError("a table has not the size that it says")
        if dtype == "bool" and size and max(content) > 1:
            raise UnsoundError("a table of yes and no holds something else")
        return np.frombuffer(content, dtype).reshape(shape).copy()
