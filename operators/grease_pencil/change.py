"""What the artist has changed of a drawing since it was traced, in few bytes.

Rerouting and locking change partners and locks; cutting and joining the graph, in steps that can
be done again; asking again the scores of pairs, from which the alternatives follow.

    zlib(partner, locks)                                   nothing else was changed
    "+" zlib(counts, bias, steps, partner, locks, scores)  anything
"""

from __future__ import annotations

import zlib
from dataclasses import replace
from typing import TYPE_CHECKING
from weakref import WeakKeyDictionary

import numpy as np

if TYPE_CHECKING:
    from ...engine import Drawing, Stroke

Array = np.ndarray

_MORE = b"+"  # a zlib stream never begins so
_MOST_STEPS = 100_000
_strokes: WeakKeyDictionary[Drawing, dict[int, Stroke]] = WeakKeyDictionary()
_HEAD = 12  # bytes: how many steps, how many scores, the balance of pen lifts


def can_be_told(base: Drawing, drawing: Drawing) -> bool:
    """Was the drawing made from that one by what can be packed? Then all else is shared."""
    graph = drawing.graph if drawing.edits is None else drawing.edits.graph
    return base.graph is graph and base.fills is drawing.fills


def again(base: Drawing, drawing: Drawing) -> Drawing:
    """A changed drawing as it will be when it is read again.

    In a sequence strokes start and run as on the frame before; one that was rerouted and is back as
    it was traced gets that start and direction back, too.
    """
    kept = _by_lowest_branch(base)
    touched: set[int] = set()
    if drawing.edits:
        from ...engine.graph.editing import edited

        touched = edited(base.graph, base.routing, drawing.edits.steps)[2]
    partner = drawing.routing.partner
    same = {id(stroke) for stroke in base.strokes}
    strokes = []
    for stroke in drawing.strokes:
        if id(stroke) not in same and len(stroke.branches):
            there = kept.get(int(stroke.branches.min()) >> 1, stroke)
            if there is not stroke and _as_traced(base, there, partner, touched):
                stroke = there
        strokes.append(stroke)
    return replace(drawing, strokes=tuple(strokes))


def _by_lowest_branch(base: Drawing) -> dict[int, Stroke]:
    if base not in _strokes:
        _strokes[base] = {int(s.branches.min()) >> 1: s for s in base.strokes if len(s.branches)}
    return _strokes[base]


def _as_traced(base: Drawing, stroke: Stroke, partner: Array, touched: set[int]) -> bool:
    """Is one stroke of the base in force again, all along?"""
    if not touched.isdisjoint((stroke.branches >> 1).tolist()):
        return False
    tips = np.concatenate([stroke.branches, stroke.branches ^ 1])
    return bool((partner[tips] == base.routing.partner[tips]).all())


def packed(base: Drawing, drawing: Drawing, *, differs: bool) -> bytes:
    """What was changed.

    Args:
        differs: tell partners and locks by how they differ from those of the base: a few dozen
            bytes; else whole.
    """
    steps = drawing.edits.steps if drawing.edits else ()
    old, new = base.routing, drawing.routing
    if steps:
        from ...engine.graph.editing import edited

        _, old, _ = edited(base.graph, base.routing, steps)
    partner, locked = new.partner, new.locked
    if differs:
        partner, locked = partner ^ old.partner, locked ^ old.locked
    body = partner.astype("<i4").tobytes() + np.packbits(locked).tobytes()
    scores = _scores_told(old.pair_score, new.pair_score)
    bias = drawing.settings.corners
    if not steps and not scores and bias == base.settings.corners:
        return zlib.compress(body, 3)
    head = np.array([len(steps), len(scores) // 8], "<i4").tobytes()
    head += np.array([bias], "<f4").tobytes() + np.array(steps, "<i4").tobytes()
    return _MORE + zlib.compress(head + body + scores, 3)


def applied(base: Drawing, told: bytes, *, differs: bool) -> Drawing:
    """The drawing that `packed` told of.

    Raises:
        ValueError, zlib.error: it was damaged.
    """
    if not told:
        return base
    if not told.startswith(_MORE):
        partner, locked = _unpacked(base, _inflated(told, _body_size(base)))
        return _routed(base, partner, locked, differs)
    return _applied(base, told[1:], differs)


def _applied(base: Drawing, told: bytes, differs: bool) -> Drawing:
    most = _HEAD + 16 * _MOST_STEPS + 2 * _body_size(base) + 16 * len(base.routing.pairs)
    raw = zlib.decompressobj().decompress(told, most)
    if len(raw) < _HEAD:
        raise ValueError("change")
    count, scored = np.frombuffer(raw, "<i4", 2).tolist()
    bias = float(np.frombuffer(raw, "<f4", 1, 8)[0])
    if not (0 <= count <= _MOST_STEPS and 0 <= scored <= len(raw) and -1 <= bias <= 1):
        raise ValueError("change")
    steps = np.frombuffer(raw, "<i4", 2 * count, _HEAD).reshape(-1, 2)
    start = base.with_edits([(int(a), int(b)) for a, b in steps])
    at, size = _HEAD + 8 * count, _body_size(start)
    if len(raw) != at + size + 8 * scored:
        raise ValueError("change")
    drawing = _routed(start, *_unpacked(start, raw[at : at + size]), differs)
    if scored:
        which = np.frombuffer(raw, "<i4", scored, at + size)
        values = np.frombuffer(raw, "<f4", scored, at + size + 4 * scored)
        drawing = _scored(drawing, which, values)
    # Blender's numbers have 32 bits: 0.3 comes back as 0.30000001.
    return replace(drawing, settings=replace(drawing.settings, corners=float(f"{bias:.6g}")))


def _scores_told(old: Array, new: Array) -> bytes:
    changed = np.flatnonzero(old != new)
    return changed.astype("<i4").tobytes() + new[changed].astype("<f4").tobytes()


def _scored(drawing: Drawing, which: Array, values: Array) -> Drawing:
    score = drawing.routing.pair_score.copy()
    if which.min() < 0 or which.max() >= len(score) or not np.isfinite(values).all():
        raise ValueError("scores")
    score[which] = values
    return drawing.with_scores(score)


def _body_size(drawing: Drawing) -> int:
    routing = drawing.routing
    return 4 * len(routing.partner) + -(-len(routing.locked) // 8)


def _inflated(told: bytes, size: int) -> bytes:
    raw = zlib.decompressobj().decompress(told, size + 1)
    if len(raw) != size:
        raise ValueError("routing")
    return raw


def _unpacked(drawing: Drawing, raw: bytes) -> tuple[Array, Array]:
    """Partners and locks."""
    halves, places = len(drawing.routing.partner), len(drawing.routing.locked)
    partner = np.frombuffer(raw, "<i4", halves).astype(np.int32)
    bits = np.unpackbits(np.frombuffer(raw, np.uint8, offset=4 * halves))
    return partner, bits[:places].astype(bool)


def _routed(start: Drawing, partner: Array, locked: Array, differs: bool) -> Drawing:
    from ...engine.soundness import check_involution

    if differs:
        partner, locked = partner ^ start.routing.partner, locked ^ start.routing.locked
    check_involution(start.graph, partner)
    return start.with_routing(partner, locked)
