"""The weights of vertex groups, which artists paint to move, tint or thicken parts of a stroke.

Blender can set them in a Grease Pencil drawing but not tell them. Geometry nodes can: a copy of the
data gets nodes that store each group as an attribute, in a scene of its own.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import bpy
import numpy as np

from .core.stroke_arrays import WEIGHT, Column, Curves, column

Array = np.ndarray

_PREFIX = "vertex group "  # keeps the names of groups apart from those of attributes
_STORED = ".involute_weight_"


def with_weights(data: bpy.types.ID, frame: int, cels: Sequence[Curves]) -> list[Curves]:
    """The strokes of each layer that has a drawing at a frame, with a column per vertex group.

    Args:
        cels: as `grease_pencil.cels_at` gives them, bottom layer first.
    """
    user = next((obj for obj in bpy.data.objects if obj.data == data), None)
    groups = [group.name for group in user.vertex_groups] if user else []
    if not groups:
        return list(cels)
    return [
        replace(cel, points=cel.points | _columns(groups, weights, int(cel.offsets[-1])))
        for cel, weights in zip(cels, _read(data, frame, groups), strict=True)
    ]


def set_weights(drawing: object, name: str, start: int, weights: Column) -> None:
    """Set the weights of the points from `start` on; what has none stays out of the group."""
    values = weights.values[:, 0]
    inside = np.flatnonzero(values > 0)
    if len(inside):
        drawing.set_vertex_weights(
            vertex_group_name=name.removeprefix(_PREFIX),
            indices=(inside + start).tolist(),
            weights=values[inside].tolist(),
            assign_mode="REPLACE",
        )


def _columns(groups: Sequence[str], weights: Sequence[Array], count: int) -> dict[str, Column]:
    return {
        _PREFIX + name: column(WEIGHT, values)
        for name, values in zip(groups, weights, strict=True)
        if len(values) == count and values.any()
    }


def _read(data: bpy.types.ID, frame: int, groups: Sequence[str]) -> list[list[Array]]:
    """The weights of each group in each drawing that a layer has at a frame."""
    scene, tree = bpy.data.scenes.new("Weights"), _storing_nodes(groups)
    copy = data.copy()
    obj = bpy.data.objects.new("Weights", copy)
    try:
        for layer in (*copy.layers, *copy.layer_groups):
            layer.hide = False  # what is hidden is not evaluated
        obj.modifiers.new("Weights", "NODES").node_group = tree
        scene.collection.objects.link(obj)
        scene.frame_current = frame
        scene.view_layers[0].update()
        shown = obj.evaluated_get(scene.view_layers[0].depsgraph).data
        keys = [layer.get_frame_at(frame) for layer in shown.layers]
        return [
            [_stored(key.drawing, number) for number in range(len(groups))]
            for key in keys
            if key is not None and key.drawing is not None
        ]
    finally:
        bpy.data.batch_remove((scene, obj, copy, tree))


def _stored(drawing: object, number: int) -> Array:
    attribute = drawing.attributes.get(f"{_STORED}{number}")
    values = np.zeros(len(attribute.data) if attribute else 0, np.float32)
    if len(values):
        attribute.data.foreach_get("value", values)
    return values


def _storing_nodes(groups: Sequence[str]) -> bpy.types.NodeTree:
    """Nodes that store the weights of each group in an attribute."""
    tree = bpy.data.node_groups.new("Weights", "GeometryNodeTree")
    for way in ("INPUT", "OUTPUT"):
        tree.interface.new_socket("Geometry", in_out=way, socket_type="NodeSocketGeometry")
    geometry = tree.nodes.new("NodeGroupInput").outputs[0]
    for number, name in enumerate(groups):
        weight = tree.nodes.new("GeometryNodeInputNamedAttribute")
        weight.data_type = "FLOAT"
        weight.inputs["Name"].default_value = name
        store = tree.nodes.new("GeometryNodeStoreNamedAttribute")
        store.data_type, store.domain = "FLOAT", "POINT"
        store.inputs["Name"].default_value = f"{_STORED}{number}"
        tree.links.new(geometry, store.inputs["Geometry"])
        tree.links.new(weight.outputs["Attribute"], store.inputs["Value"])
        geometry = store.outputs["Geometry"]
    tree.links.new(geometry, tree.nodes.new("NodeGroupOutput").inputs[0])
    return tree
