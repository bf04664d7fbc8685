"""The engine's settings as Blender properties: shared by the operator, the sidebar and presets."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from bpy.props import BoolProperty, EnumProperty, FloatProperty
from bpy.types import PropertyGroup

from ...engine import Settings
from ...engine.settings import INKS

if TYPE_CHECKING:
    import bpy

_DEFAULTS = Settings()


class TraceSettings:
    """Mixin: one property per field of `Settings`, of the same name."""

    polarity: EnumProperty(
        name="Lines",
        description="Which side of the picture is ink",
        items=[
            ("auto", "Automatic", "Find out from the picture"),
            ("dark", "Dark on Light", "Ink or pencil on paper"),
            ("light", "Light on Dark", "Chalk, blueprints, inverted scans"),
        ],
        default=_DEFAULTS.polarity,
    )
    pen_width: FloatProperty(
        name="Pen Width",
        description="Usual width of a line in pixels of the picture; 0 measures it",
        default=_DEFAULTS.pen_width,
        min=0.0,
        max=500.0,
        soft_max=50.0,
        subtype="PIXEL",
    )
    provider: EnumProperty(
        name="Line Finder",
        description="What finds the centres of the lines",
        items=[
            ("auto", "Automatic", "The trained network when it is there, else the ridge filter"),
            ("network", "Network", "Trained on pencil, ink, chalk and bad scans"),
            ("classical", "Ridge Filter", "No learning; for very clean lines"),
            ("given", "Picture Is Centerlines", "Thin white lines on black, made elsewhere"),
        ],
        default=_DEFAULTS.provider,
    )
    solids: BoolProperty(
        name="Solid Blacks",
        description="Turn areas of solid ink into fills instead of tracing them as lines",
        default=_DEFAULTS.solids,
    )
    inks: BoolProperty(
        name="Ink Colors",
        description="Give every ink its own layer and material; off draws all lines in black",
        default=_DEFAULTS.inks,
    )
    ignore_inks: EnumProperty(
        name="Ignore Inks",
        description="Inks that are not traced, such as a blue construction pencil",
        items=[(name, name.title(), "Don't trace lines of this color") for name in INKS],
        default=set(_DEFAULTS.ignore_inks),
        options={"ENUM_FLAG"},
    )
    marks: BoolProperty(
        name="Leave Out Marks",
        description="Don't trace scan borders, punched holes and registration marks",
        default=_DEFAULTS.marks,
    )
    regions: BoolProperty(
        name="Fill Regions",
        description="Fill the closed regions between the lines, on a layer below",
        default=_DEFAULTS.regions,
    )
    min_length: FloatProperty(
        name="Specks",
        description="Drop lone strokes shorter than this many pen widths",
        default=_DEFAULTS.min_length,
        min=0.0,
        max=100.0,
        soft_max=10.0,
    )
    smoothing: FloatProperty(
        name="Smoothing",
        description="0 keeps every wobble of the hand, 1 is very smooth",
        default=_DEFAULTS.smoothing,
        min=0.0,
        max=1.0,
        subtype="FACTOR",
    )
    router: EnumProperty(
        name="Junctions",
        description="What decides which lines continue through a junction",
        items=[
            ("auto", "Automatic", "The trained network when it is there, else geometry"),
            ("network", "Network", "Looks at the whole neighborhood of the junction"),
            ("geometric", "Geometry", "Looks at direction, curvature and width only"),
        ],
        default=_DEFAULTS.router,
    )
    tolerance: FloatProperty(
        name="Tolerance",
        description="How far a stroke may stray from the traced line, in pixels of the picture; "
        "more gives fewer points",
        default=_DEFAULTS.tolerance,
        min=0.0,
        max=50.0,
        soft_max=5.0,
        subtype="PIXEL",
    )
    curve: EnumProperty(
        name="Curves",
        description="What the strokes are made of",
        items=[
            ("polyline", "Points", "Plain points, for sculpting and drawing over"),
            ("bezier", "Bézier", "Few points with handles"),
        ],
        default=_DEFAULTS.curve,
    )
    device: EnumProperty(
        name="Device",
        description="Where the networks run",
        items=[
            ("auto", "Automatic", "A graphics card when one can be used, else the processor"),
            ("cpu", "Processor", "Always works"),
            ("gpu", "Graphics Card", "Needs PyTorch in Blender's Python"),
        ],
        default=_DEFAULTS.device,
    )


NAMES = tuple(TraceSettings.__annotations__)


class INVOLUTE_PG_trace_settings(TraceSettings, PropertyGroup):
    """The settings that the sidebar shows, kept in the scene."""


def as_values(source: TraceSettings) -> dict[str, Any]:
    """The settings as operators take them."""
    values = {name: getattr(source, name) for name in NAMES}
    # Blender keeps floats in 32 bits: 0.3 comes back as 0.30000001.
    return {n: float(f"{v:.6g}") if isinstance(v, float) else v for n, v in values.items()}


def engine_settings(source: TraceSettings) -> Settings:
    """The settings as the engine takes them."""
    values = as_values(source)
    return Settings(**values | {"ignore_inks": tuple(sorted(values["ignore_inks"]))})


def scene_settings(scene: bpy.types.Scene) -> INVOLUTE_PG_trace_settings:
    """What the sidebar shows."""
    return scene.involute
