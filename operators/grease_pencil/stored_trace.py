"""How one trace is kept in the ID property: encoding, and decoding with every check.

    {"drawing": bytes, "base": str,      the engine's own JSON, compressed, and its hash
     "routing": bytes, "stamp": str,     what was changed since (see `change`); hash of it all
     "earlier": {stamp: bytes},          routings that undo may bring back, as differences
     "unmarked": str,                    stamp that strokes without a mark have; missing = "stamp"
     "placement": 9 floats, "source": str,
     "path": str, "page": int, "image": str,   the picture, to trace it again
     "doubtful": int}                          how many junctions are worth a look; may be missing

A file may be cut short, or edited by other programs: whatever is wrong is said in one sentence.
"""

from __future__ import annotations

import re
import zlib
from collections import OrderedDict
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from hashlib import blake2b
from typing import TYPE_CHECKING, Any

import numpy as np

from ...engine import InvoluteError
from . import change
from .core.pixel_map import PixelMap

if TYPE_CHECKING:
    from ...engine import Drawing

Array = np.ndarray

UNSOUND = (
    "This drawing has no junctions any more: what was stored of them is damaged. "
    "Its strokes stay as they are."
)
_MAX_DECODED = 16
_MAX_EARLIER = 256  # routings; as many as Blender keeps steps to undo at most
_MOST_TEXT = 1 << 30  # bytes of JSON; a page with 100,000 strokes has 40 million
_WRONG = (
    AttributeError,
    IndexError,
    KeyError,
    OverflowError,
    RecursionError,
    TypeError,
    ValueError,
    zlib.error,
)
_STAMP = re.compile("[0-9a-f]{32}")
_decoded: OrderedDict[str, Drawing] = OrderedDict()


@dataclass(frozen=True)
class Picture:
    """Where the picture of a drawing is: a file and its page, or an image of the .blend file."""

    path: str = ""
    page: int = 0
    image: str = ""

    def as_entry(self) -> dict[str, Any]:
        """What is stored of it."""
        return {"path": self.path, "page": self.page, "image": self.image}


class UnsoundTraceError(InvoluteError):
    """What was stored is damaged; the sentence is `UNSOUND`."""


@contextmanager
def reading() -> Iterator[None]:
    """Whatever goes wrong inside is damage.

    Raises:
        UnsoundTraceError: with one sentence for people.
    """
    try:
        yield
    except UnsoundTraceError:
        raise
    except (InvoluteError, *_WRONG) as problem:
        raise UnsoundTraceError(UNSOUND) from problem


def stamp_of(entry: Any) -> str:
    """The hash of all that is stored: the same as long as nothing was changed."""
    return _text(entry, "stamp")


def source_of(entry: Any) -> str:
    """Where the drawing came from, in words."""
    return _text(entry, "source")


def doubtful_of(entry: Any) -> int:
    """How many junctions are worth a look; 0 where nobody counted them."""
    count = entry.get("doubtful", 0)
    if not isinstance(count, int):
        raise TypeError("doubtful")
    return count


def picture_of(entry: Any) -> Picture:
    """The picture that it was traced from, as far as somebody noted it.

    What is damaged of that is unknown: the junctions don't hang on it.
    """
    kinds = {"path": str, "page": int, "image": str}
    noted = {name: entry.get(name) for name in kinds}
    sound = all(isinstance(v, kinds[name]) for name, v in noted.items() if v is not None)
    return Picture(**{n: v for n, v in noted.items() if v is not None}) if sound else Picture()


def pixel_map_of(entry: Any) -> PixelMap:
    """Where its pixels lay when it was traced."""
    numbers = np.array([float(value) for value in entry["placement"]])
    if numbers.shape != (9,) or not np.isfinite(numbers).all() or np.abs(numbers).max() > 1e9:
        raise ValueError("placement")
    found = PixelMap.from_list(numbers.tolist())
    if np.linalg.norm(np.cross(found.right, found.down)) == 0:
        raise ValueError("placement")
    return found


def mark_of(stamp: str) -> int:
    """What strokes carry to say in which routing they are: 31 bits of its stamp, never 0."""
    return int(stamp[:8], 16) & 0x7FFFFFFF or 1


def stamp_among(entry: Any, marks: Iterable[int]) -> str:
    """The stamp of the routing that strokes are in.

    Args:
        marks: those that the strokes carry, the most usual first. Copies of an object that were
            decided on apart and then joined bring marks of routings that nobody remembers here.
    """
    known = _known(entry)
    return next((known[mark] for mark in marks if mark in known), stamp_of(entry))


def holds(entry: Any, mark: int) -> bool:
    """Does an entry know the routing that strokes with this mark are in?"""
    try:
        return mark in _known(entry)
    except _WRONG:
        return False


def _known(entry: Any) -> dict[int, str]:
    """The stamps of all routings that are remembered, by the marks of their strokes."""
    latest, unmarked = stamp_of(entry), entry.get("unmarked")
    earlier = entry.get("earlier")
    names = earlier.keys() if hasattr(earlier, "keys") else ()
    stamps = [*filter(_STAMP.fullmatch, names), latest]
    known = {0: unmarked if unmarked in stamps else latest}
    return known | {mark_of(stamp): stamp for stamp in stamps}


def drawing_of(entry: Any, stamp: str) -> Drawing:
    """The stored drawing in one of its routings; decoded and checked once for each content."""
    drawing = _decoded.get(stamp)
    if drawing is None:
        base = base_of(entry)
        if stamp == stamp_of(entry):
            routing = _bytes(entry, "routing")
            if stamp != _hash(_text(entry, "base").encode() + routing):
                raise ValueError("stamp")
            drawing = change.applied(base, routing, differs=False)
        else:
            drawing = change.applied(base, _bytes(entry["earlier"], stamp), differs=True)
        remember(stamp, drawing)
    return drawing


def base_of(entry: Any) -> Drawing:
    """The drawing of an entry as it was traced."""
    from ...engine.formats import drawing_json

    base = _text(entry, "base")
    drawing = _decoded.get(base)
    if drawing is None:
        blob = _bytes(entry, "drawing")
        if _hash(blob) != base:
            raise ValueError("base")
        inflate = zlib.decompressobj()
        drawing = drawing_json.read(inflate.decompress(blob, _MOST_TEXT).decode("utf-8"))
    remember(base, drawing)  # each decision needs it, and brings a drawing of its own
    return drawing


def made(
    drawing: Drawing, pixel_map: PixelMap, source: str, picture: Picture | None = None
) -> tuple[dict[str, Any], str]:
    """A new entry, and its stamp."""
    from ...engine.formats import drawing_json

    drawing = replace(drawing, edits=None)  # they are in its graph
    blob = zlib.compress(drawing_json.dumps(drawing).encode("utf-8"), 3)
    base = _hash(blob)
    stamp = _hash(base.encode())
    remember(base, drawing)
    remember(stamp, drawing)
    entry = {"drawing": blob, "base": base, "routing": b"", "stamp": stamp}
    entry |= {"placement": pixel_map.as_list(), "source": source}
    entry["doubtful"] = len(drawing.doubtful)
    return entry | (picture or Picture()).as_entry(), stamp


def rerouted(
    entry: Any, before: Drawing, drawing: Drawing, pixel_map: PixelMap, stamp_before: str
) -> tuple[dict[str, Any], str]:
    """The entry with another routing of the same drawing, and its stamp.

    Args:
        before, stamp_before: the routing that it had until now, which undo may bring back.
    """
    base = base_of(entry)
    routing = change.packed(base, drawing, differs=False)
    stamp = _hash(_text(entry, "base").encode() + routing)
    earlier = _earlier(entry)
    for known, one in ((stamp_before, before), (stamp, drawing)):
        earlier.pop(known, None)
        earlier[known] = change.packed(base, one, differs=True)
    changed = {name: entry[name] for name in ("drawing", "base", "source")}
    changed |= picture_of(entry).as_entry() | {"doubtful": len(drawing.doubtful)}
    changed |= {"routing": routing, "stamp": stamp, "placement": pixel_map.as_list()}
    changed["earlier"] = dict(list(earlier.items())[-_MAX_EARLIER:])
    unmarked = entry.get("unmarked")
    changed["unmarked"] = unmarked if isinstance(unmarked, str) else stamp_of(entry)
    remember(stamp, drawing)
    return changed, stamp


def remember(stamp: str, drawing: Drawing) -> None:
    """Keep a drawing for the next look-up of its stamp."""
    _decoded[stamp] = drawing
    _decoded.move_to_end(stamp)
    while len(_decoded) > _MAX_DECODED:
        _decoded.popitem(last=False)


def _earlier(entry: Any) -> dict[str, bytes]:
    """The routings that undo may bring back, by their stamps; what is damaged of them is none."""
    known = entry.get("earlier")
    items = known.items() if hasattr(known, "items") else ()
    return {
        stamp: told for stamp, told in items if _STAMP.fullmatch(stamp) and isinstance(told, bytes)
    }


def _hash(content: bytes) -> str:
    return blake2b(content, digest_size=16).hexdigest()


def _text(entry: Any, name: str) -> str:
    value = entry[name]
    if not isinstance(value, str):
        raise TypeError(name)
    return value


def _bytes(entry: Any, name: str) -> bytes:
    value = entry[name]
    if not isinstance(value, bytes):
        raise TypeError(name)
    return value
