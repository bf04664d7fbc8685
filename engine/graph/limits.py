"""Every limit that decides what becomes of a line, with its unit, its reason, and its evidence.

`python -m benchmarks.graph_limits` halves and doubles each of them on held-out pages and writes
what that does to the drawings to docs/graph-limits.md: a limit without effect is none, and one
with a better value than its own is to be mended. Where a limit was found in another way, `source`
says so. What only says how finely something is computed (samples, rounds, chunks) stays beside it.

Units: px of the working page, on which the ridges of all providers are 2 px wide; ridge widths and
pen widths; points, which lie 1 px apart along a branch; shares of a brightness or a length; costs,
in units of a half-branch that runs on into none.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field, fields
from typing import Any

MEASURED = "python -m benchmarks.graph_limits"
_HAIRPINS = "tests/engine/test_hairpins.py"
_DASHES = "tests/engine/test_dashes.py"


def _limit(value: float, unit: str, why: str, source: str = MEASURED) -> Any:
    return field(default=value, metadata={"unit": unit, "why": why, "source": source})


@dataclass(frozen=True)
class Limits:
    """The values in force; `table()` has what they are."""

    ridge_width: float = _limit(
        2.0,
        "px",
        "width of a line in every centerline map, whatever the pen",
        "LineMaps, a contract",
    )
    # ridge: where lines run
    ridge_sigma: float = _limit(
        0.8,
        "px",
        "of the derivatives: 0.7 to 0.9 separate parallels 2.5 px apart, and average noise",
    )
    ridge_faint: float = _limit(0.1, "share", "a line may fade to this brightness of the map ...")
    ridge_clear: float = _limit(0.33, "share", "... when it reaches this one somewhere")
    ridge_peak: float = _limit(0.6, "share", "what smoothing leaves of the crest of a line")
    ridge_valley: float = _limit(
        0.02, "1/px²", "curved upwards by more is a valley beside a line, not a line"
    )
    # forks, spurs, rungs: what thinning makes of a line
    fork_touching: float = _limit(1.0, "ridge widths", "forks linked by less are one")
    spur_longest: float = _limit(
        1.5,
        "ridge widths",
        "shorter loose branches are spurs, when nothing is known of their ends",
    )
    spur_no_end: float = _limit(0.1, "share", "below this brightness no end is seen at a tip")
    spur_end: float = _limit(0.5, "share", "above this brightness an end is seen at a tip")
    spur_unseen: float = _limit(5.0, "times", "longer may be a spur on a fork that nobody sees")
    junction_seen: float = _limit(
        0.5,
        "share",
        "of the junction map near a fork: 24 of 25 true ones have more, every other false one",
    )
    rung_longest: float = _limit(6.0, "ridge widths", "the longest bridge between two lines")
    # courses: where a half-branch goes
    course_reach: float = _limit(
        1.6, "px", "a second line nearer than this bends the ridge of a first one noticeably"
    )
    course_dirty: float = _limit(0.05, "share", "what a point beside another line still counts")
    course_fade: float = _limit(8.0, "points", "how far a direction is read along a half-branch")
    # continuations: which half-branches run on into which
    continue_noise: float = _limit(0.2, "px", "how far ridge points stray from a smooth line")
    continue_turn: float = _limit(40.0, "degrees", "a bend that costs as much as an end")
    continue_swerve: float = _limit(
        20.0, "degrees", "a bend with a counter-bend that costs as much as an end"
    )
    continue_bent: float = _limit(0.8, "share", "of the bend that both sides foretell is free")
    continue_ink: float = _limit(
        0.35, "share", "a curve stays this bright, compared with the fainter of its two sides"
    )
    continue_side: float = _limit(
        0.4,
        "cosine",
        "both half-branches leave the cluster to their own side this clearly",
    )
    # clusters: which forks are one junction or several, resolved together
    cluster_link: float = _limit(4.0, "px", "forks linked by less are one cluster")
    cluster_shared: float = _limit(60.0, "px", "the longest that may carry two lines")
    cluster_aside: float = _limit(
        1.3, "px", "how far beside a curve a branch may lie that it explains"
    )
    cluster_gain: float = _limit(0.15, "cost", "what a merger of clusters must save")
    # tips and bends
    tip_longest: float = _limit(24.0, "px", "the stem of a V that is a tip")
    tip_overlap: float = _limit(
        3.5, "times", "as long as its arms part fast is how long two lines overlap in a tip"
    )
    tip_pens: float = _limit(
        9.0, "pen widths", "the stem of a V that is a tip, if more: 7 degrees", _HAIRPINS
    )
    tip_meets: float = _limit(
        0.6,
        "share",
        "of a stem at which its straight arms meet, at least, or its inverse, at most: so 9 of 10 "
        "hairpins of 8 to 17 degrees do, and no other stem on 9 held-out pages",
        _HAIRPINS,
    )
    tip_far: float = _limit(
        3.0, "ridge widths", "the stem of a hairpin over which its arms run straight", _HAIRPINS
    )
    tip_eye: float = _limit(
        3.0, "ridge widths", "the sides of a loop at a stem that is none, but a dent", _HAIRPINS
    )
    bend_sharp: float = _limit(50.0, "degrees", "a line that turns by more has a bend there")
    bend_at_once: float = _limit(
        0.45, "share", "of a bend happens within half the way; a small circle turns less"
    )
    bend_ring: int = _limit(40, "points", "a ring shorter than this turns everywhere: no bend")
    # junctions: where lines meet
    junction_merge: float = _limit(1.4, "px", "crossings nearer than this are one junction")
    junction_touch: float = _limit(0.6, "px", "curves that come this near touch")
    junction_bent: float = _limit(0.4, "cost", "of a continuation that is none too smooth")
    junction_star: float = _limit(
        0.6, "px", "how far beside their meeting point straight half-branches may pass"
    )
    junction_stray: float = _limit(6.0, "px", "a stem may miss the curve it ends on by this much")
    junction_ink: float = _limit(
        0.5, "share", "a junction moves only while the line stays as bright as this"
    )
    # shared ridges: two lines that are one ridge
    shared_near: float = _limit(1.6, "px", "curves that come nearer are one ridge there")
    shared_shallow: float = _limit(
        40.0, "degrees", "steeper ones have a clear ridge right up to their crossing"
    )
    shared_blur: float = _limit(
        0.9, "px", "standard deviation of the scanned line and of the map's smoothing together"
    )
    shared_beyond: float = _limit(10.0, "px", "outside the exits that are looked at as well")
    shared_huber: float = _limit(0.06, "share", "of brightness; more is something else")
    shared_farthest: float = _limit(
        1.5, "px", "a curve that would move more than this was not understood"
    )
    # ends and gaps
    end_left: float = _limit(0.6, "share", "of the line's brightness that is left at its end")
    gap_widest: float = _limit(
        2.0, "pen widths", "between two ends: a gap of one pen width in the ink"
    )
    gap_least: float = _limit(3.0, "px", "are bridged however fine the pen is")
    gap_straight: float = _limit(35.0, "degrees", "that two ends may turn to meet")
    gap_aside: float = _limit(0.35, "share", "of a gap that its two ends may lie apart sideways")
    # dashed and dotted lines
    dash_bare: float = _limit(
        0.35, "share", "of the most ink on a line; less is a gap in it", _DASHES
    )
    dash_gap: float = _limit(
        8.0, "pen widths", "between two dashes or dots of a line, at most", _DASHES
    )
    dash_turn: float = _limit(30.0, "degrees", "that a dash may point beside the next one", _DASHES)
    dash_bend: float = _limit(
        50.0, "degrees", "that a line of dots may turn at one of them", _DASHES
    )
    dash_dot: float = _limit(1.5, "pen widths", "a shorter mark has no direction: a dot", _DASHES)
    dash_uneven: float = _limit(
        0.35, "share", "that gaps, and dashes with their gap, may differ", _DASHES
    )
    dash_most: float = _limit(0.8, "share", "of the dashes of a line that are alike", _DASHES)
    dash_fewest: int = _limit(3, "times", "a gap of a dashed line comes, at least", _DASHES)
    # smoothing and planarity
    smooth_rounds: int = _limit(10, "times", "all points move with the strongest smoothing")
    crossing_same: float = _limit(
        1.0, "px", "a crossing this near to a vertex of both branches is that vertex"
    )
    # measures
    width_agreed: int = _limit(4, "points", "on either side that agree on a width")
    width_widest: float = _limit(
        16.0,
        "pen widths",
        "wider is no line, as in scan.wide_lines",
        "tests/engine/test_wide_lines.py",
    )
    # what was most probably never drawn, dust, stubs
    undrawn_sure: float = _limit(
        0.5, "probability", "of never having been drawn from which on a branch goes"
    )
    undrawn_longest: float = _limit(5.0, "pen widths", "a longer branch stays in any case")
    dust_speck: float = _limit(0.25, "pen widths", "of ink beyond Settings.min_length")
    dust_point: float = _limit(
        0.01, "px", "long: a point has no direction and is no line", "tests/engine/test_dust.py"
    )
    dust_full: float = _limit(80, "percentile", "of strength that is the full ink of the page")
    dust_faint: float = _limit(
        0.5, "share", "of the full ink below which a piece is as likely a scratch as a line"
    )
    dot_narrowest: float = _limit(
        0.75, "pen widths", "of a dot, for each of Settings.min_length", "tests/engine/test_dust.py"
    )
    dot_solid: float = _limit(
        0.85,
        "share",
        "of the full ink that a dot has: on 48 held-out pages 8 of 8 dots, and 3 of 5 specks",
        "tests/engine/test_dust.py",
    )
    stub_tip: float = _limit(
        1.5,
        "times",
        "Settings.min_length: a stroke with a loose tip; none of 318 as short as this and the next "
        "limit was true on 72 held-out pages",
    )
    stub_between: float = _limit(2.0, "times", "Settings.min_length: a stroke between two lines")


LIMITS = Limits()


@dataclass(frozen=True)
class Row:
    """One limit as the table has it."""

    name: str
    value: float
    unit: str
    why: str
    source: str


def table() -> list[Row]:
    """All limits."""
    return [Row(f.name, getattr(LIMITS, f.name), **f.metadata) for f in fields(Limits)]


@contextmanager
def changed(**values: float) -> Iterator[None]:
    """Other values for a while, to measure what a limit is worth; not for use in threads."""
    known = {name: getattr(LIMITS, name) for name in values}
    try:
        for name, value in values.items():
            object.__setattr__(LIMITS, name, value)
        yield
    finally:
        for name, value in known.items():
            object.__setattr__(LIMITS, name, value)
