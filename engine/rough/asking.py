"""One way in for a drawing that asks about its bundles, and is cleaned again by the answers."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np

from ..errors import InvoluteError
from ..settings import Settings
from ..values import Answers, Array, Beside, Bundle, Pencil
from .answered import answered, between
from .cleaning import Bundled, Cleaned, cleaned
from .doubted import answers_at, bundles_of, runs_of
from .remembered import recalled, working_shape

_NEAR = 2.5  # pen widths; a bundle that is traced again lies that near to where it was
_AT = (0.25, 0.5, 0.75)  # of the span of an answer: there it is looked for on another trace


def questions(
    pencil: Pencil, scale: float, size: tuple[int, int], first: int
) -> tuple[Bundle, ...]:
    """What can be asked of the pencil strokes of a drawing; first: the number of the first."""
    if pencil.beside is None:
        return ()
    asked = answered(recalled(pencil.beside, scale, size), pencil.answers, scale)
    says = np.zeros(len(pencil.strokes), bool)
    says[pencil.said[:, 0]] = True
    return bundles_of(asked, pencil.answers, says, scale, first)


def cleaned_again(
    kept: Beside, answers: Answers, settings: Settings, scale: float, size: tuple[int, int]
) -> Cleaned:
    """The lines that the pencil strokes mean, as the artist answered."""
    asked = answered(recalled(kept, scale, size), answers, scale)
    return cleaned(asked.bundles, settings, working_shape(scale, size))


def with_answers(answers: Answers, given: Iterable[tuple[Bundle, bool | None]]) -> Answers:
    """The answers with others to some questions: one line, two lines, or None = not answered."""
    rows = [(np.array(b.strokes), np.array(b.span), one) for b, one in given]
    return _with_rows(answers, rows)


def with_lines(
    pencil: Pencil, lines: Sequence[Sequence[int]], one: bool, scale: float, size: tuple[int, int]
) -> Answers:
    """The answers that make one of some lines, or of each of them its pencil strokes.

    Args:
        lines: the pencil strokes of each. one: make one line where strokes of two of them run
            beside each other; else two where strokes of the same do.

    Raises:
        InvoluteError: none run beside each other.
    """
    assert pencil.beside is not None, "nothing is known of what runs beside each other"
    runs = runs_of(answered(recalled(pencil.beside, scale, size), Answers.none(), scale))
    on = np.zeros((len(lines), len(pencil.strokes)), bool)
    for number, strokes in enumerate(lines):
        on[number, list(strokes)] = True
    first, second = (on[:, runs.strokes[:, side]] for side in (0, 1))
    together = (first & second).any(0)
    chosen = ~together & first.any(0) & second.any(0) if one else together
    rows = [(runs.strokes[k], scale * runs.span[k], one) for k in np.flatnonzero(chosen).tolist()]
    if not rows:
        raise InvoluteError("No pencil strokes of these lines run beside each other.")
    return _with_rows(pencil.answers, rows)


def _with_rows(answers: Answers, rows: Sequence[tuple[Array, Array, bool | None]]) -> Answers:
    """The answers with those for some strokes and spans; what was said of these goes."""
    kept = np.ones(len(answers.one), bool)
    for strokes, span, _ in rows:
        before = int(answers_at(answers, strokes[None], span[None])[0])
        if before >= 0:
            kept[before] = False
    given = [(strokes, span, one) for strokes, span, one in rows if one is not None]
    pairs = [answers.strokes[kept], *(strokes[None] for strokes, _, _ in given)]
    spans = [answers.spans[kept], *(span[None] for _, span, _ in given)]
    return Answers(
        np.concatenate(pairs).astype(np.int32),
        np.concatenate(spans).astype(np.float32),
        np.concatenate([answers.one[kept], np.array([one for *_, one in given], bool)]),
    )


def carried_answers(
    old: Pencil, new: Pencil, scales: tuple[float, float], size: tuple[int, int]
) -> tuple[Answers, int]:
    """The answers of one trace for another one of the same page, and how many found no place.

    Args:
        scales: input pixels per working pixel, of the old trace and the new one.
        size: (width, height) of the page, input pixels.
    """
    if not len(old.answers.one) or old.beside is None or new.beside is None:
        return new.answers, len(old.answers.one)
    before, now = recalled(old.beside, scales[0], size), recalled(new.beside, scales[1], size)
    runs = runs_of(answered(now, Answers.none(), scales[1]))
    places = scales[1] * _both_ends(now, np.arange(len(now.rungs.a)))
    near = _NEAR * scales[1] * now.pen
    carried, lost = new.answers, 0
    rows = zip(old.answers.strokes, old.answers.spans, old.answers.one.tolist(), strict=True)
    for pair, span, one in rows:
        own = between(before, pair, span / scales[0])
        own = own[np.argsort(before.strokes.place[before.rungs.a[own]], kind="stable")]
        asked = own[[int(share * len(own)) for share in _AT]] if len(own) else own
        found = set()
        for place in scales[0] * _both_ends(before, asked):
            away = np.hypot(*np.moveaxis(places - place, -1, 0)).max(1)
            away[runs.of_rung < 0] = np.inf
            if len(away) and away.min() <= near:
                found.add(int(runs.of_rung[away.argmin()]))
        lost += not found
        carried = _with_rows(
            carried, [(runs.strokes[k], scales[1] * runs.span[k], one) for k in sorted(found)]
        )
    return carried, lost


def _both_ends(found: Bundled, rungs: Array) -> Array:
    """(K, 2, 2) working pixels: where some rungs begin and end."""
    of, points = found.rungs, found.strokes.points
    return np.stack([points[of.a[rungs]], points[of.b[rungs]]], 1)


def parts_of(
    pencil: Pencil, bundle: Bundle, scale: float, size: tuple[int, int]
) -> tuple[Array, Array]:
    """(N, 2) px: the part of either pencil stroke that a question is about."""
    assert pencil.beside is not None, "there is no question without it"
    found = recalled(pencil.beside, scale, size)
    own = between(found, bundle.strokes, np.array(bundle.span) / scale)
    both = np.unique(np.concatenate([found.rungs.a[own], found.rungs.b[own]]))
    parts = []
    for stroke in bundle.strokes:
        mine = both[found.strokes.stroke[both] == stroke]
        mine = mine[np.argsort(found.strokes.place[mine], kind="stable")]
        parts.append(scale * found.strokes.points[mine])
    return parts[0], parts[1]
