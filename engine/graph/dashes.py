"""A dashed or dotted line is one line.

# Strategy: a mark, a dash or a dot, is a piece of line with two ends; one that crosses other lines
# runs on straight through them. Marks are linked where a branch goes on over bare paper already,
# and then from the nearest pair on: a dash to what lies ahead of its ends, a dot to two opposite
# sides. Chains of links are cut where a gap is of another length; what is left is a dashed line
# when it has enough gaps, and marks as even as these. A branch goes across each such gap, so that
# all that follows sees one line, its junctions with others included.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from ..arrays.sampling import sample
from ..settings import Settings
from ..values import Array, PlanarGraph, Scan
from .evidence import Evidence
from .gaps import bridged, looks
from .lifts import split
from .limits import LIMITS
from .measure import over_paper
from .nearby import near_pairs
from .topology import join, lengths, means, select

Link = tuple[int, int]
_NONE = -1


def join_dashes(graph: PlanarGraph, evidence: Evidence, settings: Settings) -> PlanarGraph:
    """Add a branch across every gap of a dashed or dotted line, when the user asks for it.

    Reads: Settings.dashes, the ink and the width of the pen; points about 1 px apart.
    Promises: dashes, dots and the gaps between them are one branch up to the next junction; not
        planar where they cross other lines.
    """
    if not settings.dashes or evidence.scan is None or graph.branch_count == 0:
        return graph
    whole, bare = _cut_at_gaps(graph, evidence.scan)
    marks = _Marks.of(whole, bare, evidence.pen_width)
    if marks is None:
        return graph
    known = marks.over_gaps(whole, bare)
    link, way = _links(marks, known)
    runs = [run for chain in _chains(marks, link) for run in _even(chain, marks)]
    there = {frozenset(pair) for pair in known}
    gaps = [gap for run in runs for gap in run if frozenset(gap) not in there]
    if not gaps:
        return graph
    gaps += _behind_lines(runs, marks, way, evidence.scan)
    lines = [marks.across(a, b, way) for a, b in gaps]
    return join(bridged(whole, marks.vertex[np.array(gaps)], lines))


def _cut_at_gaps(graph: PlanarGraph, scan: Scan) -> tuple[PlanarGraph, Array]:
    """The graph cut where its branches leave the ink, without loose ends beyond it; and (B,) bool,
    which branches are gaps between two marks."""
    bare = over_paper(graph, scan)
    inner = np.ones(len(bare), bool)
    inner[graph.offsets[:-1]] = inner[graph.offsets[1:] - 1] = False
    changes = np.flatnonzero(bare[1:] != bare[:-1])
    at = np.unique(np.where(bare[changes], changes + 1, changes))  # the one with ink of both
    pieces = split(replace(graph, bare=bare), at[inner[at]])
    assert pieces.bare is not None
    gap = means(pieces, pieces.bare) > 0
    loose = (pieces.degrees[pieces.ends] == 1).any(1)
    pieces = select(replace(pieces, bare=None), ~(gap & loose))
    gap = gap[~(gap & loose)]
    return pieces, gap & (pieces.degrees[pieces.ends] == 2).all(1)


@dataclass(frozen=True, eq=False)
class _Marks:
    """The ends of marks.

    vertex: (N,) where each lies. tip: (N, 2) px, and out: (N, 2) unit vector in which its line
    would go on. over: (N,) the other end of the mark. length: (N,) px from one to the other.
    dot: (N,) bool, too short to have a direction. pen: px.
    """

    vertex: Array
    tip: Array
    out: Array
    over: Array
    length: Array
    dot: Array
    pen: float

    @staticmethod
    def of(whole: PlanarGraph, gap: Array, pen: float) -> _Marks | None:
        """Of a graph of which some branches are gaps; None where no line has an end."""
        left = np.flatnonzero(~gap)
        graph = replace(  # with the vertices of the whole
            select(whole, ~gap), vertices=whole.vertices, ends=whole.ends[left]
        )
        size = lengths(graph)
        loose = np.flatnonzero(graph.degrees[graph.half_vertex] == 1)
        runs = [(int(one), *_through(graph, int(one), size)) for one in loose]
        if not runs:
            return None
        # A dash that ends on another line may go on beyond it.
        begun = set(loose.tolist())
        runs += [(far, one, long) for one, far, long in runs if far not in begun]
        half, far, length = (np.array(column) for column in zip(*runs, strict=True))
        number = np.full(2 * graph.branch_count, _NONE)
        number[half] = np.arange(len(half))
        tip, out = looks(graph, half)
        dot = length < LIMITS.dash_dot * pen
        return _Marks(graph.half_vertex[half], tip, out, number[far], length, dot, pen)

    def over_gaps(self, whole: PlanarGraph, gap: Array) -> list[Link]:
        """The pairs of ends between which a branch lies already."""
        number = np.full(len(whole.vertices), _NONE)
        number[self.vertex] = np.arange(len(self.vertex))
        pairs = number[whole.ends[gap]]
        return [(int(a), int(b)) for a, b in pairs[(pairs != _NONE).all(1)]]

    def gap(self, a: int, b: int) -> float:
        return float(np.hypot(*(self.tip[b] - self.tip[a])))

    def across(self, a: int, b: int, way: Array) -> Array:
        """(N, 2) a smooth line over a gap, 1 px from point to point."""
        far = self.gap(a, b)
        t = np.linspace(0, 1, max(2, round(far) + 1))[:, None]
        p, q = self.tip[a], self.tip[b]
        u, v = far * self.heading(a, way), -far * self.heading(b, way)
        line: Array = (
            (1 + 2 * t) * (1 - t) ** 2 * p
            + t * (1 - t) ** 2 * u
            + t**2 * (3 - 2 * t) * q
            + t**2 * (t - 1) * v
        )
        return line

    def heading(self, end: int, way: Array) -> Array:
        """The unit vector in which a line leaves an end, a dot by its neighbours."""
        own = way[end] + (-way[self.over[end]] if self.dot[end] else self.out[end])
        unit: Array = own / max(float(np.hypot(*own)), 1e-9)
        return unit


def _through(graph: PlanarGraph, half: int, length: Array) -> tuple[int, float]:
    """The half-branch at the far end of the line that begins with one, straight through all
    junctions, and how long it is, px."""
    whole = float(length[half >> 1])
    for _ in range(graph.branch_count):
        far = half ^ 1
        others = graph.halves_of(int(graph.half_vertex[far]))
        if len(others) % 2:  # it ends there, loose or on another line
            break
        _, out = looks(graph, others)
        turn = out @ out[others == far][0]
        best = int(turn.argmin())
        if turn[best] > -np.cos(np.radians(LIMITS.dash_turn)):
            break
        half = int(others[best])
        whole += float(length[half >> 1])
    return half ^ 1, whole


def _links(marks: _Marks, known: list[Link]) -> tuple[Array, Array]:
    """(N,) which end each end is linked to, -1 for none, and (N, 2) the unit vector to that."""
    link, way = np.full(len(marks.tip), _NONE), np.zeros((len(marks.tip), 2))
    a, b = near_pairs(marks.tip, LIMITS.dash_gap * marks.pen).T
    gap = np.hypot(*(marks.tip[b] - marks.tip[a]).T)
    to = (marks.tip[b] - marks.tip[a]) / np.maximum(gap, 1e-9)[:, None]
    ahead = np.minimum(
        np.where(marks.dot[a], 1.0, (marks.out[a] * to).sum(1)),
        np.where(marks.dot[b], 1.0, -(marks.out[b] * to).sum(1)),
    )
    fits = (ahead > np.cos(np.radians(LIMITS.dash_turn))) & (gap < LIMITS.dash_gap * marks.pen)
    fits &= marks.over[a] != b
    order = np.argsort((gap * (2 - ahead))[fits], kind="stable")
    nearest = zip(a[fits][order].tolist(), b[fits][order].tolist(), strict=True)
    there = set(known)
    for one, other in [*known, *nearest]:
        toward = marks.tip[other] - marks.tip[one]
        toward = toward / max(float(np.hypot(*toward)), 1e-9)
        if (one, other) not in there:
            one, other = (
                _side(marks, link, way, end, to) for end, to in ((one, toward), (other, -toward))
            )
        if _NONE in (one, other) or link[one] != _NONE or link[other] != _NONE or one == other:
            continue
        if marks.over[one] == other:
            continue
        link[one], link[other] = other, one
        way[one], way[other] = toward, -toward
    return link, way


def _side(marks: _Marks, link: Array, way: Array, end: int, toward: Array) -> int:
    """The end of a mark that can go on in a direction, -1 for none: of a dot either one, but
    opposite to the link that it has."""
    if not marks.dot[end]:
        return end
    over = int(marks.over[end])
    if link[end] != _NONE:
        end, over = over, end
    bent = way[over] @ toward > -np.cos(np.radians(LIMITS.dash_bend))
    return _NONE if link[over] != _NONE and bent else end


def _chains(marks: _Marks, link: Array) -> list[list[Link]]:
    """The links in the order of their lines: (end that a mark leaves by, end of the next)."""
    seen = np.zeros(len(link), bool)
    chains = []
    linked = np.flatnonzero(link != _NONE)
    first = linked[link[marks.over[linked]] == _NONE]  # and then rings
    for end in [*first.tolist(), *linked.tolist()]:
        chain = []
        while link[end] != _NONE and not seen[end]:
            other = int(link[end])
            seen[[end, other]] = True
            chain.append((end, other))
            end = int(marks.over[other])
        if chain:
            chains.append(chain)
    return chains


def _even(chain: list[Link], marks: _Marks) -> list[list[Link]]:
    """The parts of a chain whose links are gaps of a dashed line."""
    gaps = np.array([marks.gap(*link) for link in chain])
    typical = float(np.median(gaps))
    good = np.abs(gaps - typical) <= LIMITS.dash_uneven * typical + 1
    bounds = np.flatnonzero(np.diff(good.astype(int), prepend=0, append=0))
    found = []
    for first, last in bounds.reshape(-1, 2).tolist():
        inner = np.array([marks.length[b] for (_, b), _ in pairwise(chain[first:last])])
        if last - first >= LIMITS.dash_fewest and _alike(inner, gaps[first:last]):
            found.append(chain[first:last])
    return found


def _behind_lines(runs: list[list[Link]], marks: _Marks, way: Array, scan: Scan) -> list[Link]:
    """The links between the ends of dashed lines that go on where another line hides a mark."""
    ends: list[int] = []
    step: list[float] = []
    for run in runs:
        ends += [int(marks.over[run[0][0]]), int(marks.over[run[-1][1]])]
        inner = marks.length[[b for _, b in run[:-1]]]
        step += [float(np.median(inner)) + float(np.median([marks.gap(*link) for link in run]))] * 2
    end, due = np.array(ends), np.array(step)
    i, j = near_pairs(marks.tip[end], (2 + 2 * LIMITS.dash_uneven) * max(step)).T
    gap = np.hypot(*(marks.tip[end[j]] - marks.tip[end[i]]).T)
    two_on = np.abs(gap / np.maximum(due[i], due[j]) - 2) <= 2 * LIMITS.dash_uneven
    two_on &= marks.over[end[i]] != end[j]
    found: list[tuple[float, Link]] = []
    for a, b in np.stack([end[i], end[j]], -1)[two_on].tolist():
        far = marks.gap(a, b)
        line = marks.across(a, b, way)
        to = (marks.tip[b] - marks.tip[a]) / far
        ahead = min(marks.heading(a, way) @ to, -marks.heading(b, way) @ to)
        hidden = sample(scan.ink, line[len(line) // 3 : -(len(line) // 3)]).max(initial=0) > 0.5
        if hidden and ahead > np.cos(np.radians(LIMITS.dash_turn)):
            found.append((far, (a, b)))
    links: list[Link] = []
    taken: set[int] = set()
    for _, link in sorted(found):
        if taken.isdisjoint(link):
            links.append(link)
            taken.update(link)
    return links


def _alike(marks: Array, gaps: Array) -> bool:
    """Whether the marks between even gaps are alike, or alike in turn, as of a chain line; some
    may be several that were never apart."""
    gap = float(np.median(gaps))
    for turns in (1, 2):
        if len(marks) < 2 * turns:
            continue
        off = []
        for own in (marks[k::turns] + gap for k in range(turns)):
            times = own / np.percentile(own, 30)
            off.append(np.abs(times - np.maximum(np.rint(times), 1)))
        if np.mean(np.concatenate(off) < LIMITS.dash_uneven) >= LIMITS.dash_most:
            return True
    return False
