"""Runs a small ONNX network in torch, so that one weights file serves every backend.

Knows only the operations that the centerline network is made of.
"""

from __future__ import annotations

import torch
from torch import Tensor, nn

from .. import onnx_file
from ..errors import InvoluteError
from ..onnx_file import Node


class OnnxModule(nn.Module):  # type: ignore[misc]  # torch is no part of this environment
    """A network read from ONNX: one input, one output or more, of which a call gives the first."""

    def __init__(
        self, nodes: list[Node], weights: dict[str, Tensor], source: str, results: list[str]
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


def _run(node: Node, given: list[Tensor]) -> Tensor:
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
    try:
        read = onnx_file.read(data)
    except ValueError as error:
        raise InvoluteError(f"Can't read the weights: {error}.") from error
    weights = {name: torch.from_numpy(values.copy()) for name, values in read.weights.items()}
    return OnnxModule(read.nodes, weights, read.inputs[-1], read.outputs).eval()
