"""Rerouting by joining and splitting the strokes that are there, whatever the artist did to them.

Pure NumPy. Strokes that nobody touched become exactly the engine's new strokes; where an artist
has worked, the pieces themselves are cut and joined, with all their attributes.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from ....engine import InvoluteError
from .pieces import EPSILON, Piece, cut, join, piece_of, reversed_piece
from .pixel_map import PixelMap
from .stretches import Stretch, changed_halves, stretches_of, strokes_through, whole_length
from .stroke_arrays import ALONG, BEZIER, HALF, POLY, TRACE, Column, Curves, column, stroke_curves

if TYPE_CHECKING:
    from ....engine import Drawing, Stroke

Array = np.ndarray

_LOST = 0.5  # of a stretch; an end with more missing than that is not the end it was
_TOGETHER = 3.0  # px; ends that are this near become one point
_UNTELLABLE = (
    "A stroke at this junction was changed so much that its ends can't be told; "
    "nothing was changed."
)
_GONE = "The strokes at this junction were deleted, or joined by hand; nothing was changed."
_SHORTER = 0.02  # share of a stroke's length that smoothing it anew may take
_OWN = ("cyclic", "curve_type", TRACE, HALF)  # attributes of strokes that are set here

Source = tuple[Stretch, bool]  # a stretch of an old stroke, and whether it is walked backward


@dataclass(frozen=True, eq=False)
class Edit:
    """What changes in one Grease Pencil drawing: see `cels.replace`."""

    removed: list[int] = field(default_factory=list)
    added: list[Curves] = field(default_factory=list)
    slots: list[int] = field(default_factory=list)


def plan(
    old: Drawing, new: Drawing, cels: Sequence[Curves], key: int, pixel_map: PixelMap
) -> list[Edit]:
    """How to turn the strokes of one routing into those of another.

    Args:
        old, new: the same graph in two routings.
        cels: what the layers show; strokes of the trace may be on any of them.
        key: of the trace.

    Returns:
        One edit per cel.

    Raises:
        InvoluteError: the ends of a stroke that has to be joined or split can't be told, or
            none of the strokes is there.
    """
    splicer = _Splicer(old, new, cels, key, pixel_map)
    edits = splicer.edits()
    if splicer.pieces and not any(edit.removed for edit in edits):
        raise InvoluteError(_GONE)
    _check_nothing_lost(edits, cels, pixel_map, int(splicer.changed.sum()))
    return edits


def untouched_strokes(
    drawing: Drawing, cels: Sequence[Curves], key: int, pixel_map: PixelMap
) -> set[int]:
    """The numbers of the strokes that are still just as the engine made them.

    Args:
        cels, key: as for `plan`.
    """
    splicer = _Splicer(drawing, drawing, cels, key, pixel_map)
    splicer.pieces = splicer.find(range(len(drawing.strokes)), strict=False)
    return {k for k in range(len(drawing.strokes)) if splicer.is_untouched(k)}


class _Splicer:
    def __init__(
        self, old: Drawing, new: Drawing, cels: Sequence[Curves], key: int, pixel_map: PixelMap
    ) -> None:
        self.old, self.new, self.cels = old, new, cels
        self.key, self.pixel_map = key, pixel_map
        self.changed = changed_halves(old, new)
        affected = strokes_through(old, self.changed)
        self.pieces = self.find(affected)
        self.untouched = {index for index in affected if self.is_untouched(index)}
        # Every stretch by the half-branch that it begins with, walked either way.
        self.stretches: dict[int, Source] = {}
        for index in affected:
            for stretch in stretches_of(old, index, self.changed):
                self.stretches[stretch.halves[-1] ^ 1] = (stretch, True)
                self.stretches[stretch.halves[0]] = (stretch, False)

    def edits(self) -> list[Edit]:
        """Remove what the changed strokes have become; put the new strokes in their places."""
        edits = [Edit() for _ in self.cels]
        for pieces in self.pieces.values():
            for piece in pieces:
                edits[piece.cel].removed.append(piece.index)
        for index in strokes_through(self.new, self.changed):
            stroke = self.new.strokes[index]
            parts = list(stretches_of(self.new, index, self.changed))
            sources = [self.stretches.get(part.halves[0]) for part in parts]
            origins = {source[0].stroke for source in sources if source}
            if origins and origins <= self.untouched:
                pieces = [piece for origin in origins for piece in self.pieces[origin]]
                main = max(pieces, key=len)
                self._add(edits, main, stroke_curves([stroke], self.pixel_map, self.key, 0))
                continue
            for piece in self._spliced(stroke, parts, sources):
                self._add(edits, piece, self._as_curves(piece, int(stroke.branches[0])))
        return edits

    # --- what is there ---

    def find(self, affected: Sequence[int], *, strict: bool = True) -> dict[int, list[Piece]]:
        """The Grease Pencil strokes that each traced stroke has become, in order along it.

        Args:
            strict: raise where the points of one can't be told; else it counts as gone.
        """
        owner = {int(h) >> 1: i for i in affected for h in self.old.strokes[i].branches}
        found: dict[int, list[Piece]] = {index: [] for index in affected}
        for number, cel in enumerate(self.cels):
            halves = cel.mark(HALF) - 1
            mine = (cel.mark(TRACE) == self.key) & np.isin(halves >> 1, list(owner))
            for curve in np.flatnonzero(mine).tolist():
                index = owner[int(halves[curve]) >> 1]
                stroke = self.old.strokes[index]
                piece = piece_of(cel, number, curve, whole_length(stroke))
                if piece is None:
                    if strict:
                        raise InvoluteError(_UNTELLABLE)
                    continue
                # A copy that the artist made lies over the original: it is nobody's piece.
                if not any(_overlap(piece, other) for other in found[index]):
                    found[index].append(piece)
        return {i: sorted(pieces, key=lambda p: p.along[0]) for i, pieces in found.items()}

    @cached_property
    def _traced(self) -> Curves:
        """The strokes that `pieces` is about, in its order, as the engine made them."""
        strokes = [self.old.strokes[index] for index in self.pieces]
        return stroke_curves(strokes, self.pixel_map, self.key, 0)

    @cached_property
    def _rows(self) -> dict[int, int]:
        """The first row of each of them."""
        return dict(zip(self.pieces, self._traced.offsets.tolist(), strict=False))

    def is_untouched(self, index: int) -> bool:
        """Is the stroke still just as the engine made it?"""
        stroke, pieces = self.old.strokes[index], self.pieces[index]
        if len(pieces) != 1 or len(pieces[0]) != len(stroke.points):
            return False
        piece = pieces[0]
        if piece.cyclic != stroke.closed or piece.bezier != (stroke.handles is not None):
            return False
        part = slice(self._rows[index], self._rows[index] + len(stroke.points))
        for name, col in piece.points.items():
            made = self._traced.points.get(name)
            if made is not None and (piece.bezier or not name.startswith("handle_")):
                values, is_place = made.values[part], made.type == "FLOAT_VECTOR"
                near = EPSILON * self.pixel_map.unit if is_place else 1e-3 * values
                if name != ALONG and (np.abs(col.values - values) > near).any():
                    return False
            elif col.values.any() and not name.startswith((".", "handle_")):
                return False  # such as a colour painted on
        return True

    def _cut(self, stretch: Stretch) -> list[Piece]:
        """What is there of a stretch, in the direction of its old stroke."""
        stroke = self.old.strokes[stretch.stroke]
        whole = whole_length(stroke) if stroke.closed else None
        turns = [0.0] if whole is None else [0.0, whole, -whole, 2 * whole]
        cuts = []
        for piece in self.pieces[stretch.stroke]:
            for turn in turns[:1] if piece.cyclic else turns:
                shifted = replace(piece, along=piece.along + turn)
                cuts.append(cut(shifted, stretch.start, stretch.end, whole))
        return sorted((c for c in cuts if c is not None), key=lambda c: c.along[0])

    # --- what is to be there ---

    def _spliced(
        self, stroke: Stroke, parts: Sequence[Stretch], sources: Sequence[Source | None]
    ) -> list[Piece]:
        """A new stroke from pieces of old ones, joined wherever nothing is missing."""
        chains: list[list[Piece]] = []
        joins = False
        first_is_there = False
        for number, (part, source) in enumerate(zip(parts, sources, strict=True)):
            pieces = self._cut(source[0]) if source else []
            is_there = bool(pieces)
            if is_there:
                before = number > 0 or stroke.closed
                after = number < len(parts) - 1 or stroke.closed
                stretch, backward = source
                _check_ends(pieces, stretch, *((after, before) if backward else (before, after)))
                pieces = _moved(pieces, source, part)
                if joins:
                    chains[-1].append(pieces.pop(0))
                chains += [[piece] for piece in pieces]
                first_is_there |= number == 0
            joins = is_there
        closed = stroke.closed and joins and first_is_there
        if closed and len(chains) > 1:
            chains[0] = chains.pop() + chains[0]
            closed = False
        near = _TOGETHER * self.pixel_map.unit
        made = [join(chain, near, closed) for chain in chains]
        if stroke.closed:
            whole = whole_length(stroke)
            made = [replace(piece, along=np.mod(piece.along, whole)) for piece in made]
        return made

    def _as_curves(self, piece: Piece, half: int) -> Curves:
        points = piece.points | {ALONG: column("FLOAT", piece.along)}
        curves = {
            "cyclic": column("BOOLEAN", np.array([piece.cyclic])),
            "curve_type": column("INT8", np.array([BEZIER if piece.bezier else POLY])),
            TRACE: column("INT", np.array([self.key])),
            HALF: column("INT", np.array([half + 1])),
        }
        return Curves(np.array([0, len(piece)], np.int32), points, curves)

    def _add(self, edits: list[Edit], main: Piece, curves: Curves) -> None:
        """Put a stroke in the place of `main`, with the attributes of that stroke."""
        taken_over = {
            name: Column(c.type, c.values[main.index : main.index + 1])
            for name, c in self.cels[main.cel].curves.items()
            if name not in _OWN
        }
        edit = edits[main.cel]
        edit.added.append(replace(curves, curves=curves.curves | taken_over))
        edit.slots.append(main.index)


def _check_nothing_lost(
    edits: Sequence[Edit], cels: Sequence[Curves], pixel_map: PixelMap, ends: int
) -> None:
    """Whatever strokes say of themselves, what is taken away comes back joined otherwise.

    Args:
        ends: how many half-branches continue differently; each may lose what lies together.
    """
    removed = sum(_lengths(cel)[edit.removed].sum() for cel, edit in zip(cels, edits, strict=True))
    added = sum(_lengths(curves).sum() for edit in edits for curves in edit.added)
    if removed - added > _SHORTER * removed + ends * _TOGETHER * pixel_map.unit:
        raise InvoluteError(_UNTELLABLE)


def _lengths(curves: Curves) -> Array:
    """(n,) length of each stroke's polygon in object units, round to the start of closed ones."""
    places = curves.point("position").reshape(-1, 3).astype(np.float64)
    steps = np.linalg.norm(np.diff(places, axis=0), axis=1)
    along = np.concatenate([[0.0], np.cumsum(steps)])
    first, last = curves.offsets[:-1], curves.offsets[1:] - 1
    closing = np.linalg.norm(places[last] - places[first], axis=1) * curves.curve("cyclic")
    return along[last] - along[first] + closing


def _overlap(a: Piece, b: Piece) -> bool:
    return a.along[0] < b.along[-1] - EPSILON and b.along[0] < a.along[-1] - EPSILON


def _check_ends(pieces: Sequence[Piece], stretch: Stretch, at_start: bool, at_end: bool) -> None:
    """Where a stretch is to be joined, its end must still be there."""
    lost = _LOST * (stretch.end - stretch.start)
    if (at_start and pieces[0].along[0] - stretch.start > lost) or (
        at_end and stretch.end - pieces[-1].along[-1] > lost
    ):
        raise InvoluteError(_UNTELLABLE)


def _moved(pieces: Sequence[Piece], source: Source, part: Stretch) -> list[Piece]:
    """The pieces of a stretch as parts of a new stroke: its direction, its lengths."""
    stretch, backward = source
    scale = (part.end - part.start) / max(stretch.end - stretch.start, 1e-9)
    if not backward:
        return [replace(p, along=part.start + (p.along - stretch.start) * scale) for p in pieces]
    return [
        reversed_piece(p, (part.end - (p.along - stretch.start) * scale)[::-1])
        for p in reversed(pieces)
    ]
