"""Convolutions with strides at the rim of a network, as ordinary ones of the image's phases.

OpenCV convolves a grey page with a stride slowly, and took a fifth of the centerline network's
time for the transposed convolution at its end. Both equal convolutions without strides: of an
image whose every second row and column, beginning at each of the first, is a channel of its own
(its phases), or to such an image. The phases are taken apart and put together by NumPy, outside.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from . import onnx_file
from .onnx_file import Network, Node
from .values import Array

# What may stand between a transposed convolution and an output: each pixel by itself.
_POINTWISE = frozenset({"Relu", "Sigmoid", "Identity"})
_KNOWN = _POINTWISE | {"Add", "Cast", "Concat", "Conv", "ConvTranspose"}


@dataclass(frozen=True)
class InPhases:
    """content: of an ONNX file. inputs, outputs: name -> its stride, of those that are in phases;
    the sides of the images have to be multiples of it. order: the names of all outputs."""

    content: bytes
    inputs: dict[str, int]
    outputs: dict[str, int]
    order: tuple[str, ...]


def in_phases(content: bytes) -> InPhases | None:
    """The same network, its inputs and outputs in phases wherever strides lead from or to them.

    None: it holds other operations than the centerline network, or nothing that gains.

    Raises:
        ValueError: as `onnx_file.read`.
    """
    network = onnx_file.read(content)
    if any(node.kind not in _KNOWN for node in network.nodes):
        return None
    network = network.without_casts()
    inputs: dict[str, int] = {}
    outputs: dict[str, int] = {}
    for node in list(network.nodes):
        step = _step(node) if node.kind in ("Conv", "ConvTranspose") else 1
        if step == 1:
            continue
        if node.kind == "Conv" and _alone(network, node):
            inputs[node.inputs[0]] = step
            network = _of_phases(network, node, step)
        elif node.kind == "ConvTranspose" and (name := _leads_to(network, node.outputs[0])):
            outputs[name] = step
            network = _to_phases(network, node, step)
    if not (inputs or outputs):
        return None
    return InPhases(onnx_file.write(network), inputs, outputs, tuple(network.outputs))


def apart(image: Array, step: int) -> Array:
    """(1, C, H, W) -> its phases, (1, step * step * C, H / step, W / step), row phases first."""
    _, channels, height, width = image.shape
    split = image.reshape(channels, height // step, step, width // step, step)
    phases = split.transpose(2, 4, 0, 1, 3).reshape(1, -1, height // step, width // step)
    return np.ascontiguousarray(phases)


def together(phases: Array, step: int) -> Array:
    """The image whose phases these are; the inverse of `apart`."""
    _, count, height, width = phases.shape
    image = np.empty((1, count // step**2, height * step, width * step), phases.dtype)
    split = phases.reshape(step, step, count // step**2, height, width)
    for row, column in np.ndindex(step, step):
        image[0, :, row::step, column::step] = split[row, column]
    return image


def _alone(network: Network, node: Node) -> bool:
    """Whether a convolution reads an input, and nothing else does."""
    readers = [other for other in network.nodes if node.inputs[0] in other.inputs]
    return node.inputs[0] in network.inputs and len(readers) == 1


def _leads_to(network: Network, name: str) -> str | None:
    """The output that a value becomes, pixel by pixel, and that alone; None for none."""
    readers = [node for node in network.nodes if name in node.inputs]
    if name in network.outputs:
        return None if readers else name
    if len(readers) != 1 or readers[0].kind not in _POINTWISE:
        return None
    return _leads_to(network, readers[0].outputs[0])


def _step(node: Node) -> int:
    """The stride of a convolution; 1 where it is none that can be taken apart."""
    a = node.attributes
    alike = all(len(set(a.get(name, [1]))) == 1 for name in ("strides", "pads", "kernel_shape"))
    plain = set(a.get("dilations", [1])) == {1} and a.get("group", [1]) == [1]
    if not (alike and plain and len(node.inputs) == 3 and {"strides", "pads"} <= a.keys()):
        return 1
    step = a["strides"][0]
    # So that an image of H rows becomes one of H / step, or step * H.
    return step if a["kernel_shape"][0] - 2 * a["pads"][0] == step else 1


def _places(size: int, before: int, step: int) -> tuple[list[tuple[int, int]], int]:
    """Of each tap of a kernel the rows away and the phase of the row that it stands over, and how
    many rows away that is at most."""
    places = [divmod(tap - before, step) for tap in range(size)]
    return places, max(abs(away) for away, _ in places)


def _of_phases(network: Network, node: Node, step: int) -> Network:
    """The network with a strided convolution as one of phases."""
    before = node.attributes["pads"][0]
    kernel = network.weights[node.inputs[1]]
    out, channels, size, _ = kernel.shape
    # Tap t of the kernel reads row step * i + t - before.
    places, reach = _places(size, before, step)
    taps = np.zeros((out, step, step, channels, 2 * reach + 1, 2 * reach + 1), np.float32)
    for y, (down, row) in enumerate(places):
        for x, (right, column) in enumerate(places):
            taps[:, row, column, :, down + reach, right + reach] = kernel[:, :, y, x]
    changed = taps.reshape(out, -1, 2 * reach + 1, 2 * reach + 1)
    return _exchanged(network, node, changed, network.weights[node.inputs[2]])


def _to_phases(network: Network, node: Node, step: int) -> Network:
    """The network with a transposed convolution as one whose answer is in phases."""
    before = node.attributes["pads"][0]
    kernel = network.weights[node.inputs[1]]
    channels, out, size, _ = kernel.shape
    # Row i writes tap t to row step * i + t - before.
    places, reach = _places(size, before, step)
    taps = np.zeros((step, step, out, channels, 2 * reach + 1, 2 * reach + 1), np.float32)
    for y, (down, row) in enumerate(places):
        for x, (right, column) in enumerate(places):
            taps[row, column, :, :, reach - down, reach - right] = kernel[:, :, y, x].T
    changed = taps.reshape(-1, channels, 2 * reach + 1, 2 * reach + 1)
    bias = np.tile(network.weights[node.inputs[2]], step**2)
    return _exchanged(network, node, changed, bias)


def _exchanged(network: Network, node: Node, kernel: Array, bias: Array) -> Network:
    """The network with a node as an ordinary convolution of another kernel."""
    size = kernel.shape[2]
    attributes = {
        "dilations": [1, 1], "group": [1], "kernel_shape": [size, size],
        "pads": [size // 2] * 4, "strides": [1, 1],
    }  # fmt: skip
    ordinary = Node("Conv", node.inputs, node.outputs, attributes)
    nodes = [ordinary if other is node else other for other in network.nodes]
    weights = {**network.weights, node.inputs[1]: kernel, node.inputs[2]: bias}
    return replace(network, nodes=nodes, weights=weights)
