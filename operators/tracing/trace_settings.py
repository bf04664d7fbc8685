"""The engine's settings as Blender properties: shared by the operator, the sidebar and presets."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

from bpy.props import BoolProperty, EnumProperty, FloatProperty, IntProperty
from bpy.types import PropertyGroup

from ...engine import Settings
from ...engine.settings import ABOUT, DEFAULTS, About
from . import live
from .placing import PlacingSettings

if TYPE_CHECKING:
    import bpy

_SUBTYPES = {"px": "PIXEL", "share": "FACTOR"}


def _property(about: About, default: Any) -> Any:
    """The Blender property of one setting."""
    shown = {"name": about.label, "description": about.tip}
    if about.kind is bool:
        return BoolProperty(**shown, default=default)
    if about.choices:
        items = [(choice.value, choice.label, choice.tip) for choice in about.choices]
        if about.kind is tuple:
            return EnumProperty(**shown, items=items, default=set(default), options={"ENUM_FLAG"})
        return EnumProperty(**shown, items=items, default=default)
    shown |= {"default": default, "min": about.low, "max": about.high}
    shown |= {"soft_max": about.soft_high or about.high}
    make = IntProperty if about.kind is int else FloatProperty
    return make(**shown, subtype=_SUBTYPES.get(about.unit, "NONE"))


class TraceSettings:
    """Mixin: one property per declared field of `Settings`, of the same name."""

    __annotations__ = {name: _property(about, DEFAULTS[name]) for name, about in ABOUT.items()}


NAMES = tuple(ABOUT)


def for_operators(settings: type) -> type:
    """The same properties for an operator, which forgets what the last call was given.

    So what is set tells what this very call asked for; the rest is the sidebar's.
    """
    made = {}
    for name, prop in settings.__annotations__.items():
        options = {*prop.keywords.get("options", {"ANIMATABLE"}), "SKIP_SAVE"}
        made[name] = prop.function(**(prop.keywords | {"options": options}))
    return type(f"{settings.__name__}Options", (), {"__annotations__": made})


def _watched(settings: type) -> type:
    """The same properties, which tell when they change."""
    made = {}
    for name, prop in settings.__annotations__.items():
        made[name] = prop.function(**(prop.keywords | {"update": live.changed}))
    return type(f"Watched{settings.__name__}", (), {"__annotations__": made})


WatchedSettings = _watched(TraceSettings)


class INVOLUTE_PG_trace_settings(WatchedSettings, PlacingSettings, PropertyGroup):
    """The settings that the sidebar shows, kept in the scene."""

    filled: BoolProperty(options={"HIDDEN"})


TraceOptions = for_operators(TraceSettings)
PlacingOptions = for_operators(PlacingSettings)


def take_from_sidebar(operator: bpy.types.Operator, context: bpy.types.Context) -> None:
    """Give an operator the sidebar's settings, but for those that it was called with."""
    settings = scene_settings(context.scene)
    for name in (*NAMES, *PlacingSettings.__annotations__):
        if (
            name in operator.properties.bl_rna.properties
            and not operator.properties.is_property_set(name)
        ):
            setattr(operator, name, getattr(settings, name))


def set_defaults(settings: INVOLUTE_PG_trace_settings, context: bpy.types.Context) -> None:
    """Set settings to the defaults of the preferences."""
    package = __package__.removesuffix(".operators.tracing")
    addon = context.preferences.addons.get(package)
    if addon is not None and addon.preferences is not None:
        defaults = addon.preferences.defaults
        for name in (*NAMES, *PlacingSettings.__annotations__):
            setattr(settings, name, getattr(defaults, name))


def as_values(source: TraceSettings) -> dict[str, Any]:
    """The settings as operators take them."""
    values = {name: getattr(source, name) for name in NAMES}
    # Blender keeps floats in 32 bits: 0.3 comes back as 0.30000001.
    return {n: float(f"{v:.6g}") if isinstance(v, float) else v for n, v in values.items()}


def take_from_engine(settings: object, wanted: Settings, names: Iterable[str] = NAMES) -> None:
    """Set properties to what a drawing was traced with."""
    for name in names:
        value = getattr(wanted, name)
        setattr(settings, name, set(value) if isinstance(value, tuple) else value)


def engine_settings(source: TraceSettings) -> Settings:
    """The settings as the engine takes them."""
    values = as_values(source)
    chosen = {n: tuple(sorted(v)) for n, v in values.items() if ABOUT[n].kind is tuple}
    return Settings(**values | chosen)


def scene_settings(scene: bpy.types.Scene) -> INVOLUTE_PG_trace_settings:
    """What the sidebar shows."""
    return scene.involute
