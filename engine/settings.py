"""Everything a user can choose about one trace, with defaults that suit a scanned ink drawing.

A setting is declared once, as a field of `Settings`; its check, its option on the command line, its
property and place in the sidebar and its row in the manual all follow from that.
"""

from __future__ import annotations

from dataclasses import asdict, dataclass, field, fields
from itertools import chain
from math import isfinite
from numbers import Integral, Real
from typing import Any

from .errors import InvoluteError

WHAT, CLEAN, POINTS = GROUPS = ("What the Drawing Is", "How Clean", "How Many Points")
# The stages of a trace whose results are kept; see `kept_stages`.
STAGES = ("scan", "solids", "centerline", "graph", "routing", "strokes")
INKS = ("red", "orange", "yellow", "green", "cyan", "blue", "purple", "pink", "gray")


@dataclass(frozen=True)
class Choice:
    """One value of a setting with a few: as it is written, as it is shown, and what it means."""

    value: str
    label: str
    tip: str


@dataclass(frozen=True, kw_only=True)
class About:
    """What is to be known of a setting, wherever it is shown.

    kind: bool, int, float, str (one of `choices`) or tuple (any of them).
    group: the part of the sidebar and of the manual that it stands in, one of `GROUPS`.
    label: its name in the sidebar.
    tip: what it does, for people; a phrase that begins with a capital and ends without a dot.
    off: what `--no-...` does, for a switch that is on by default.
    more: what the manual adds.
    low, high: the least and the most of a number; soft_high: how far a slider goes.
    stage: the first of `STAGES` that reads it; those before it need not run again when it changes.
    unit: "px" of the input, "pens" (typical widths of a line), "share" (0 to 1), or "".
    """

    kind: type
    group: str
    stage: str
    label: str
    tip: str
    off: str = ""
    more: str = ""
    choices: tuple[Choice, ...] = ()
    low: float = 0.0
    high: float = 1.0
    soft_high: float | None = None
    unit: str = ""

    @property
    def values(self) -> tuple[str, ...]:
        return tuple(choice.value for choice in self.choices)


def _declared(default: Any, kind: type, **about: Any) -> Any:
    return field(default=default, metadata={"about": About(kind=kind, **about)})


def _switch(default: bool, **about: Any) -> Any:
    return _declared(default, bool, **about)


def _number(default: float, low: float, high: float, **about: Any) -> Any:
    """A whole number when the default is one."""
    return _declared(default, type(default), low=low, high=high, **about)


def _one_of(*choices: tuple[str, str, str], **about: Any) -> Any:
    """One of a few words; the first is the default."""
    options = tuple(Choice(*choice) for choice in choices)
    return _declared(options[0].value, str, choices=options, **about)


def _any_of(*choices: tuple[str, str, str], **about: Any) -> Any:
    """Any of a few words; none by default."""
    return _declared((), tuple, choices=tuple(Choice(*choice) for choice in choices), **about)


@dataclass(frozen=True)
class Settings:
    """Settings of one trace; all lengths in input pixels unless stated otherwise.

    align: where the punched holes (or marks) shall lie, in px of the input; the page is turned and
        moved to that; see `registration.anchors_of`. Empty = the page stays as it lies. It is
        measured, never typed in, and so has no option of its own.
    """

    drawing: str = _one_of(
        ("clean", "Clean", "Every line is drawn once"),
        ("auto", "Automatic", "Rough where many lines run beside themselves"),
        ("rough", "Rough", "Many pencil strokes say one line: find that line"),
        stage="strokes",
        group=WHAT,
        label="Drawing",
        tip="Whether every line is drawn once or by many pencil strokes",
        more="See [from rough to clean](rough.md)",
    )
    polarity: str = _one_of(
        ("auto", "Automatic", "Find out from the picture"),
        ("dark", "Dark on Light", "Ink or pencil on paper"),
        ("light", "Light on Dark", "Chalk, blueprints, inverted scans"),
        group=WHAT,
        stage="scan",
        label="Lines",
        tip="Which side of the picture is ink",
    )
    pen_width: float = _number(
        0.0,
        0.0,
        500.0,
        soft_high=50.0,
        unit="px",
        group=WHAT,
        stage="scan",
        label="Pen Width",
        tip="Usual width of a line in pixels of the picture; 0 measures it",
        more="Set it when the page holds a few thin lines beside large black areas",
    )
    inks: bool = _switch(
        True,
        group=WHAT,
        stage="strokes",
        label="Ink Colors",
        tip="Give every ink its own layer and material; off draws all lines in black",
        off="make all strokes black instead of the color of their ink",
        more="Pencil under ink has a layer of its own too",
    )
    ignore_inks: tuple[str, ...] = _any_of(
        *((name, name.title(), "Don't trace lines of this color") for name in INKS),
        group=WHAT,
        stage="scan",
        label="Ignore Inks",
        tip="Inks that are not traced, such as a blue construction pencil",
        more="`gray` is pencil under ink",
    )
    solids: bool = _switch(
        True,
        group=WHAT,
        stage="solids",
        label="Solid Blacks",
        tip="Turn areas of solid ink into fills instead of tracing them as lines",
        off="trace solid black areas as lines too, instead of making them fills",
    )
    solid_width: float = _number(
        0.0,
        0.0,
        1000.0,
        soft_high=100.0,
        unit="px",
        group=WHAT,
        stage="solids",
        label="Solid Width",
        tip="Lines wider than this, in pixels of the picture, are solid areas; 0 finds out from "
        "the pen",
    )
    sheet: bool = _switch(
        True,
        group=WHAT,
        stage="scan",
        label="Leave Out Surroundings",
        tip="Don't trace what lies beyond the sheet in a photograph: cloth, a desk, a finger",
        off="trace what lies beyond the sheet in a photograph too",
    )
    straighten: bool = _switch(
        False,
        group=WHAT,
        stage="scan",
        label="Straighten Sheet",
        tip="Take the perspective out of a photographed sheet, as seen from straight above",
        more="Where all four corners of the sheet are sure; the result says so. The drawing no "
        "longer lies on the lines of the photo",
    )
    rules: bool = _switch(
        True,
        group=WHAT,
        stage="scan",
        label="Leave Out Rules",
        tip="Don't trace the printed lines of ruled and squared paper",
        off="trace the printed lines of ruled and squared paper too",
    )
    show_through: bool = _switch(
        True,
        group=WHAT,
        stage="scan",
        label="Leave Out the Back",
        tip="Don't trace what shows through from the back of the sheet, paler and softer",
        off="trace what shows through from the back of the sheet too",
        more="Kept, it comes on the layer of pencil",
    )
    screentone: bool = _switch(
        True,
        group=WHAT,
        stage="scan",
        label="Leave Out Screentone",
        tip="Don't trace areas of evenly set dots, such as the tones of a comic",
        off="trace every dot of a screentone",
    )
    marks: bool = _switch(
        True,
        group=WHAT,
        stage="scan",
        label="Leave Out Marks",
        tip="Don't trace scan borders, punched holes and registration marks",
        off="trace scan borders, punched holes and registration marks too",
    )
    regions: bool = _switch(
        False,
        group=WHAT,
        stage="strokes",
        label="Fill Regions",
        tip="Fill the closed regions between the lines, on a layer below",
        more="White, or the color that is painted there; in Blender and SVG",
    )
    small_parts: float = _number(
        0.0,
        0.0,
        1000.0,
        soft_high=60.0,
        unit="pens",
        group=WHAT,
        stage="strokes",
        label="Small Parts",
        tip="Put what hangs together and is smaller than this many pen widths, such as lettering, "
        "on layers of its own; 0 doesn't",
        more="Hide or delete the layer to leave it out; letters of 3 mm are 10 to 30 pens tall",
    )
    align: tuple[tuple[float, float], ...] = ()
    grain: str = _one_of(
        (
            "auto",
            "Automatic",
            "Closely, and where soft lines are torn from afar as well; the simpler drawing is kept",
        ),
        ("fine", "Fine", "As close as the pen is wide: ink, markers, clean pencil"),
        ("medium", "Medium", "At 0.7 of that size: soft pencil, crayon"),
        ("coarse", "Coarse", "At 0.55 of that size: charcoal, chalk, rough paper"),
        ("coarsest", "Coarsest", "At 0.4 of that size: what falls to shreds even so"),
        group=WHAT,
        stage="scan",
        label="Grain",
        tip="From how far the page is looked at, so that grainy lines are whole",
        more="The frames of a sequence are looked at as suits the first of them",
    )
    min_length: float = _number(
        1.0,
        0.0,
        100.0,
        soft_high=10.0,
        unit="pens",
        group=CLEAN,
        stage="graph",
        label="Specks",
        tip="Drop lone strokes shorter than this many pen widths",
        more="Strokes that hang on other lines are dropped up to twice that length",
    )
    dots: bool = _switch(
        True,
        group=CLEAN,
        stage="graph",
        label="Keep Dots",
        tip="Keep dots of full ink about as wide as the pen, which are no specks",
        off="drop small dots as specks",
        more="Dots wider than three quarters of *Specks* times the pen",
    )
    dashes: bool = _switch(
        False,
        group=CLEAN,
        stage="graph",
        label="Join Dashes",
        tip="Make one stroke of a dashed or dotted line, and note how it is dashed",
        more="From four even dashes or dots on; they run on through junctions. SVG shows the gaps",
    )
    smoothing: float = _number(
        0.3,
        0.0,
        1.0,
        unit="share",
        group=CLEAN,
        stage="graph",
        label="Smoothing",
        tip="0 keeps every wobble of the hand, 1 is very smooth",
        more="Corners stay",
    )
    corners: float = _number(
        0.0,
        -1.0,
        1.0,
        group=CLEAN,
        stage="routing",
        label="Pen Lifts",
        tip="Where strokes end though only two lines meet: -1 nowhere, 0 where it looks as if the "
        "pen was lifted, 1 wherever it may have been",
        more="See [corners](junctions.md#corners)",
    )
    provider: str = _one_of(
        ("auto", "Automatic", "The trained network when it is there, else the ridge filter"),
        ("network", "Network", "Trained on pencil, ink, chalk and bad scans"),
        (
            "lean",
            "Lean Network",
            "Smaller, in three quarters of the time; cuts grainy lines more",
        ),
        ("classical", "Ridge Filter", "No learning; for very clean lines"),
        ("given", "Picture Is Centerlines", "Thin white lines on black, made elsewhere"),
        group=CLEAN,
        stage="centerline",
        label="Line Finder",
        tip="What finds the centres of the lines",
    )
    router: str = _one_of(
        ("auto", "Automatic", "The trained network when it is there, else geometry"),
        ("network", "Network", "Looks at the whole neighborhood of the junction"),
        ("geometric", "Geometry", "Looks at direction, curvature and width only"),
        group=CLEAN,
        stage="routing",
        label="Junctions",
        tip="What decides which lines continue through a junction",
    )
    device: str = _one_of(
        ("auto", "Automatic", "A graphics card when one can be used, else the processor"),
        ("cpu", "Processor", "Always works"),
        ("gpu", "Graphics Card", "Needs PyTorch in Blender's Python"),
        group=CLEAN,
        stage="centerline",
        label="Device",
        tip="Where the networks run",
        more="The processor does well",
    )
    opacity: str = _one_of(
        ("auto", "Automatic", "Solid for ink, as drawn for pencil"),
        ("solid", "Solid", "Every stroke is opaque"),
        ("drawn", "As Drawn", "As strong as the line on the paper"),
        group=POINTS,
        stage="strokes",
        label="Opacity",
        tip="How opaque the strokes are",
        more="One value for a stroke, unless the line really fades along it",
    )
    width_scale: float = _number(
        1.0,
        0.05,
        20.0,
        soft_high=3.0,
        group=POINTS,
        stage="strokes",
        label="Width Scale",
        tip="Make the strokes this many times as wide as the lines on the paper",
    )
    even_width: bool = _switch(
        False,
        group=POINTS,
        stage="strokes",
        label="Even Width",
        tip="Give each stroke one width all along, that of its line on average",
    )
    curve: str = _one_of(
        ("polyline", "Points", "Plain points, for sculpting and drawing over"),
        ("bezier", "Bézier", "Few points with handles"),
        group=POINTS,
        stage="strokes",
        label="Curves",
        tip="What the strokes are made of",
        more="Curves have less than half the points: those at bends, corners, junctions and where "
        "the pressure changes",
    )
    tolerance: float = _number(
        0.15,
        0.0,
        50.0,
        soft_high=5.0,
        unit="px",
        group=POINTS,
        stage="strokes",
        label="Tolerance",
        tip="How far a stroke may stray from the traced line, in pixels of the picture; "
        "more gives fewer points",
    )

    def __post_init__(self) -> None:
        # Files and command lines give lists; a setting has to be a value that can be compared.
        object.__setattr__(self, "align", _places(self.align))
        for name, about in ABOUT.items():
            if about.kind is tuple and isinstance(getattr(self, name), list):
                object.__setattr__(self, name, tuple(getattr(self, name)))
            _check(name, about, getattr(self, name))

    def as_dict(self) -> dict[str, Any]:
        """The settings as plain values, for files and reports."""
        return asdict(self)


ABOUT: dict[str, About] = {
    setting.name: setting.metadata["about"]
    for setting in fields(Settings)
    if "about" in setting.metadata
}
# Of `align`, too, which is nobody's to set.
STAGE_OF = {name: about.stage for name, about in ABOUT.items()} | {"align": "scan"}
DEFAULTS: dict[str, Any] = {setting.name: setting.default for setting in fields(Settings)}


def _check(name: str, about: About, value: Any) -> None:
    """Refuse what a setting can't be.

    Raises:
        InvoluteError: says what it can be.
    """
    if about.choices:
        many = about.kind is tuple and isinstance(value, tuple)
        for word in value if many else [value]:
            if word not in about.values:
                choices = ", ".join(about.values)
                raise InvoluteError(f"Setting {name} can't be {word!r}; choose from {choices}.")
    elif about.kind is bool:
        if not isinstance(value, bool):
            raise InvoluteError(f"Setting {name} must be true or false.")
    else:
        kind, what = (Integral, "whole number") if about.kind is int else (Real, "number")
        if isinstance(value, bool) or not isinstance(value, kind):
            raise InvoluteError(f"Setting {name} must be a {what}.")
        if not about.low <= value <= about.high:  # type: ignore[operator]  # a Real has an order
            raise InvoluteError(
                f"Setting {name} must lie between {about.low:g} and {about.high:g}."
            )


def _places(value: Any) -> tuple[tuple[float, float], ...]:
    try:
        places = tuple((float(x), float(y)) for x, y in value)
    except (TypeError, ValueError):
        raise InvoluteError("Setting align must be places (x, y).") from None
    if not all(map(isfinite, chain(*places))):
        raise InvoluteError("Setting align must be places (x, y) in px.")
    return places
