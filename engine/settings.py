"""Everything a user can choose about one trace, with defaults that suit a scanned ink drawing."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Any, Literal

from .errors import InvoluteError

Polarity = Literal["auto", "dark", "light"]
Provider = Literal["auto", "network", "classical", "given"]
Router = Literal["auto", "network", "geometric"]
Device = Literal["auto", "cpu", "gpu"]
Curve = Literal["polyline", "bezier"]

INKS = ("red", "orange", "yellow", "green", "cyan", "blue", "purple", "pink", "gray")

_CHOICES: dict[str, tuple[str, ...]] = {
    "polarity": ("auto", "dark", "light"),
    "provider": ("auto", "network", "classical", "given"),
    "router": ("auto", "network", "geometric"),
    "device": ("auto", "cpu", "gpu"),
    "curve": ("polyline", "bezier"),
}
_RANGES: dict[str, tuple[float, float]] = {
    "pen_width": (0.0, 500.0),
    "min_length": (0.0, 100.0),
    "smoothing": (0.0, 1.0),
    "corners": (-1.0, 1.0),
    "tolerance": (0.0, 50.0),
}


@dataclass(frozen=True)
class Settings:
    """Settings of one trace; all lengths in input pixels unless stated otherwise.

    What the drawing is
        polarity: which side is ink; "auto" looks at the picture ("dark" = dark lines on light).
        pen_width: typical width of a line; 0 = measured from the drawing.
        provider: what makes the centerline: "network", "classical", "given" (the input already is
            a centerline image, white on black), or "auto" (the network when its weights are there).
        solids: take solid black areas out as fills instead of tracing them.
        inks: give the strokes the colour of their ink, and grey to pencil under ink; off = all
            strokes are black.
        ignore_inks: inks that are not traced, such as a blue construction pencil; see `INKS`.
            "gray" is pencil under ink.
        marks: leave out scan borders, punched holes and registration marks.
        regions: fill the closed regions between the lines, below them, with white or with what
            was painted there.
        align: where the punched holes (or marks) shall lie, in px of the input; the page is turned
            and moved to that; see `registration.anchors_of`. Empty = the page stays as it lies.

    How clean
        min_length: strokes shorter than this many pen widths that hang on nothing are dropped, and
            those up to twice as long that hang on other lines.
        smoothing: 0 keeps every wobble, 1 is very smooth.
        corners: whether strokes end where only two lines meet: 0 = where it looks as if the pen
            was lifted, -1 = nowhere (they run through), 1 = wherever it may have been.
        router: what pairs the half-branches: "network", "geometric" or "auto".

    How many points
        tolerance: how far a simplified stroke may stray from the traced line.
        curve: "polyline" or "bezier".

    device: where the networks run; "auto" = a GPU when torch finds one, else the CPU.
    """

    polarity: Polarity = "auto"
    pen_width: float = 0.0
    provider: Provider = "auto"
    solids: bool = True
    inks: bool = True
    ignore_inks: tuple[str, ...] = ()
    marks: bool = True
    regions: bool = False
    align: tuple[tuple[float, float], ...] = ()
    min_length: float = 1.0
    smoothing: float = 0.3
    corners: float = 0.0
    router: Router = "auto"
    tolerance: float = 0.15
    curve: Curve = "polyline"
    device: Device = "auto"

    def __post_init__(self) -> None:
        # Files and command lines give lists; a setting has to be a value that can be compared.
        object.__setattr__(self, "ignore_inks", tuple(self.ignore_inks))
        object.__setattr__(self, "align", tuple((float(x), float(y)) for x, y in self.align))
        for name in self.ignore_inks:
            if name not in INKS:
                raise InvoluteError(f"There is no ink {name!r}; choose from {', '.join(INKS)}.")
        for name, allowed in _CHOICES.items():
            if getattr(self, name) not in allowed:
                raise InvoluteError(
                    f"Setting {name} can't be {getattr(self, name)!r}; "
                    f"choose one of {', '.join(allowed)}."
                )
        for name, (low, high) in _RANGES.items():
            if not low <= getattr(self, name) <= high:
                raise InvoluteError(f"Setting {name} must lie between {low:g} and {high:g}.")

    def as_dict(self) -> dict[str, Any]:
        """The settings as plain values, for files and reports."""
        return asdict(self)
