"""Runs a small ONNX network in torch, so that one weights file serves every backend.

Reads the few protobuf fields that matter (https://protobuf.dev/programming-guides/encoding/,
https://github.com/onnx/onnx/blob/main/onnx/onnx.proto) and knows only the operations that the
centerline network is made of.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
import torch
from torch import Tensor, nn

from ..errors import InvoluteError


def _fields(data: memoryview) -> Iterator[tuple[int, Any]]:
    """Number and value of each field of a protobuf message; fixed-width ones come as bytes."""
    at = 0

    def varint() -> int:
        nonlocal at
        value = shift = 0
        while True:
            byte = data[at]
            at += 1
            value |= (byte & 0x7F) << shift
            shift += 7
            if byte < 0x80:
                return value

    while at < len(data):
        key = varint()
        number, kind = key >> 3, key & 7
        if kind == 0:
            yield number, varint()
            continue
        size = {1: 8, 2: -1, 5: 4}[kind]
        size = varint() if size < 0 else size
        yield number, data[at : at + size]
        at += size


def _ints(value: int | memoryview) -> list[int]:
    """A repeated integer field: one value, or several packed."""
    if isinstance(value, int):
        return [value]
    # Packed varints read like the values of fields without keys.
    out, current, shift = [], 0, 0
    for byte in value:
        current |= (byte & 0x7F) << shift
        shift += 7
        if byte < 0x80:
            out.append(current)
            current = shift = 0
    return out


_FLOATS = {1: "<f4", 10: "<f2"}  # data_type of a TensorProto -> of NumPy


def _tensor(message: memoryview) -> tuple[str, Tensor]:
    """A TensorProto of floats: dims 1, data_type 2, name 8, raw_data 9."""
    dims: list[int] = []
    name, raw, kind = "", memoryview(b""), 1
    for number, value in _fields(message):
        if number == 1:
            dims += _ints(value)
        elif number == 2:
            kind = value
        elif number == 8:
            name = bytes(value).decode()
        elif number == 9:
            raw = value
    if kind not in _FLOATS:
        raise InvoluteError(f"The weights file holds numbers of a kind that is not known: {kind}.")
    array = np.frombuffer(raw, _FLOATS[kind]).reshape(dims)
    return name, torch.from_numpy(array.astype(np.float32))


@dataclass(frozen=True)
class _Node:
    kind: str
    inputs: list[str]
    outputs: list[str]
    attributes: dict[str, list[int]]


def _node(message: memoryview) -> _Node:
    """A NodeProto: input 1, output 2, op_type 4, attribute 5 (name 1, i 3, ints 8)."""
    kind, inputs, outputs, attributes = "", [], [], {}
    for number, value in _fields(message):
        if number == 1:
            inputs.append(bytes(value).decode())
        elif number == 2:
            outputs.append(bytes(value).decode())
        elif number == 4:
            kind = bytes(value).decode()
        elif number == 5:
            name, ints = "", []
            for inner, content in _fields(value):
                if inner == 1:
                    name = bytes(content).decode()
                elif inner in (3, 8):
                    ints += _ints(content)
            attributes[name] = ints
    return _Node(kind, inputs, outputs, attributes)


class OnnxModule(nn.Module):  # type: ignore[misc]  # torch is no part of this environment
    """A network read from ONNX: one input, one output or more, of which a call gives the first."""

    def __init__(
        self, nodes: list[_Node], weights: dict[str, Tensor], source: str, results: list[str]
    ) -> None:
        super().__init__()
        self._nodes, self._source, self._results = nodes, source, results
        self._slot = {name: f"w{k}" for k, name in enumerate(weights)}
        for name, tensor in weights.items():
            self.register_buffer(self._slot[name], tensor)

    def forward(self, x: Tensor) -> Tensor:
        return self.all_of(x)[0]

    def all_of(self, x: Tensor) -> list[Tensor]:
        """Every output of the network."""
        values = {self._source: x}
        for node in self._nodes:
            given = [
                getattr(self, self._slot[n]) if n in self._slot else values[n] for n in node.inputs
            ]
            values[node.outputs[0]] = _run(node, given)
        return [values[name] for name in self._results]


def _run(node: _Node, given: list[Tensor]) -> Tensor:
    a = node.attributes
    if node.kind == "Relu":
        return given[0].relu()
    if node.kind == "Sigmoid":
        return given[0].sigmoid()
    if node.kind == "Add":
        return given[0] + given[1]
    if node.kind == "Concat":
        return torch.cat(given, a["axis"][0])
    if node.kind in ("Identity", "Cast"):  # all numbers are 32-bit floats here
        return given[0]
    if node.kind in ("Conv", "ConvTranspose"):
        convolve = nn.functional.conv2d if node.kind == "Conv" else nn.functional.conv_transpose2d
        return convolve(*given, stride=a["strides"], padding=a["pads"][:2])
    raise InvoluteError(f"The weights file uses an operation that is not known: {node.kind}.")


def module(data: bytes) -> OnnxModule:
    """The network of an ONNX file.

    Raises:
        InvoluteError: it uses an operation that the centerline network has no use for.
    """
    graph = next(value for number, value in _fields(memoryview(data)) if number == 7)
    nodes, weights, source, results = [], {}, "", []
    for number, value in _fields(graph):  # GraphProto: node 1, initializer 5, input 11, output 12
        if number == 1:
            nodes.append(_node(value))
        elif number == 5:
            name, tensor = _tensor(value)
            weights[name] = tensor
        elif number == 11:
            source = next(bytes(v).decode() for n, v in _fields(value) if n == 1)
        elif number == 12:
            results.append(next(bytes(v).decode() for n, v in _fields(value) if n == 1))
    return OnnxModule(nodes, weights, source, results).eval()
