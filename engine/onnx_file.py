"""What an ONNX file holds: the operations of a network and their weights.

Reads and writes the few protobuf fields that matter
(https://protobuf.dev/programming-guides/encoding/,
https://github.com/onnx/onnx/blob/main/onnx/onnx.proto), so that whoever runs a network's weights in
another way needs no library for it.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from .values import Array

_FLOATS = {1: "<f4", 10: "<f2"}  # data_type of a TensorProto -> of NumPy
_OTHERS = {6: "<i4", 7: "<i8"}  # numbers that shapes and axes are made of
_LISTS = frozenset({"kernel_shape", "strides", "pads", "dilations"})  # attributes that are several
_VERSIONS = 8, 17  # of the file format and of the operations, as the shipped weights have them


@dataclass(frozen=True)
class Node:
    """One operation. attributes: name -> its whole numbers."""

    kind: str
    inputs: list[str]
    outputs: list[str]
    attributes: dict[str, list[int]]


@dataclass(frozen=True)
class Network:
    """nodes in the order in which they run; weights: name -> float32, or whole numbers."""

    nodes: list[Node]
    weights: dict[str, Array]
    inputs: list[str]
    outputs: list[str]

    def without_casts(self) -> Network:
        """The same network without what makes its stored weights 32-bit floats: they are."""
        stored = {node.outputs[0]: node.inputs[0] for node in self.nodes if node.kind == "Cast"}
        kept = {k: v for k, v in self.weights.items() if k not in stored.values()}
        cast = {name: self.weights[of] for name, of in stored.items()}
        nodes = [node for node in self.nodes if node.kind != "Cast"]
        return replace(self, nodes=nodes, weights=kept | cast)


def read(content: bytes) -> Network:
    """The network in the content of a file.

    Raises:
        ValueError: it holds none, or one with numbers of a kind that is not known.
    """
    try:
        return _network(memoryview(content))
    except (IndexError, KeyError, StopIteration, UnicodeDecodeError, TypeError) as error:
        raise ValueError("this is no ONNX file") from error


def _network(content: memoryview) -> Network:
    graph = next(value for number, value in _fields(content) if number == 7)
    found = Network([], {}, [], [])
    for number, value in _fields(graph):  # GraphProto: node 1, initializer 5, input 11, output 12
        if number == 1:
            found.nodes.append(_node(value))
        elif number == 5:
            name, tensor = _tensor(value)
            found.weights[name] = tensor
        elif number in (11, 12):
            name = next(bytes(v).decode() for n, v in _fields(value) if n == 1)
            (found.inputs if number == 11 else found.outputs).append(name)
    return found


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


def _tensor(message: memoryview) -> tuple[str, Array]:
    """A TensorProto: dims 1, data_type 2, name 8, raw_data 9."""
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
    if kind in _OTHERS:
        return name, np.frombuffer(raw, _OTHERS[kind]).reshape(dims)
    if kind not in _FLOATS:
        raise ValueError(f"the file holds numbers of a kind that is not known: {kind}")
    return name, np.frombuffer(raw, _FLOATS[kind]).reshape(dims).astype(np.float32)


def _node(message: memoryview) -> Node:
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
    return Node(kind, inputs, outputs, attributes)


def write(network: Network, *, halve: bool = False) -> bytes:
    """The content of a file of convolutions: float32 weights, images of any size in and out.

    Attributes must be whole numbers, as `read` gives them. halve: whether weights that are 16-bit
    floats are stored as such, with a Cast that makes them longer.
    """
    weights, nodes = dict(network.weights), list(network.nodes)
    for name, values in network.weights.items() if halve else ():
        small = values.astype(np.float16)
        if np.array_equal(small, values):
            del weights[name]
            weights[f"{name}.half"] = small
            nodes.insert(0, Node("Cast", [f"{name}.half"], [name], {"to": [1]}))
    graph = [_message(1, _written_node(node)) for node in nodes]
    graph += [_message(2, b"network")]
    graph += [_message(5, _written_tensor(*item)) for item in weights.items()]
    graph += [_message(11, _written_image(name)) for name in network.inputs]
    graph += [_message(12, _written_image(name)) for name in network.outputs]
    form, operations = _VERSIONS
    # ModelProto: ir_version 1, graph 7, opset_import 8 (version 2)
    return b"".join(
        [_number(1, form), _message(7, b"".join(graph)), _message(8, _number(2, operations))]
    )


def _varint(value: int) -> bytes:
    value &= (1 << 64) - 1  # negative ones as two's complement
    out = bytearray()
    while value > 0x7F:
        out.append(value & 0x7F | 0x80)
        value >>= 7
    out.append(value)
    return bytes(out)


def _number(number: int, value: int) -> bytes:
    return _varint(number << 3) + _varint(value)


def _message(number: int, value: bytes | str) -> bytes:
    content = value.encode() if isinstance(value, str) else value
    return _varint(number << 3 | 2) + _varint(len(content)) + content


def _written_node(node: Node) -> bytes:
    fields = [_message(1, name) for name in node.inputs]
    fields += [_message(2, name) for name in node.outputs]
    fields += [_message(3, node.outputs[0]), _message(4, node.kind)]
    for name, values in node.attributes.items():
        several = name in _LISTS  # AttributeProto: type 20, of which 7 is INTS and 2 is INT
        numbers = [_number(8 if several else 3, value) for value in values]
        content = [_message(1, name), *numbers, _number(20, 7 if several else 2)]
        fields.append(_message(5, b"".join(content)))
    return b"".join(fields)


def _written_tensor(name: str, values: Array) -> bytes:
    dims = [_number(1, size) for size in values.shape]
    kind = 10 if values.dtype == np.float16 else 1
    raw = values.astype(_FLOATS[kind]).tobytes()
    return b"".join([*dims, _number(2, kind), _message(8, name), _message(9, raw)])


def _written_image(name: str) -> bytes:
    """A ValueInfoProto: one image of any channels and size, (1, C, H, W) float32."""
    sizes = [_number(1, 1), *(_message(2, f"{name} {side}") for side in "chw")]
    shape = b"".join(_message(1, size) for size in sizes)
    tensor = _number(1, 1) + _message(2, shape)  # elem_type, shape
    return _message(1, name) + _message(2, _message(1, tensor))
