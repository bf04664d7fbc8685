"""The shipped weights as a network again, to train on from where they ended.

An ONNX file names biases and norms as the network does; the matrices of its products have lost
their names, but stand in the order in which the network uses them.
"""

from __future__ import annotations

from pathlib import Path

import onnx
import torch
from onnx import numpy_helper

from .set_transformer import RoutingNet


def restored(path: Path) -> RoutingNet:
    """The network that an ONNX file of `export` holds."""
    model = onnx.load(str(path))
    arrays = {i.name: numpy_helper.to_array(i) for i in model.graph.initializer}
    matrices = [
        torch.from_numpy(arrays[node.input[1]].T.copy())
        for node in model.graph.node
        if node.op_type == "MatMul" and node.input[1] in arrays
    ]
    width, edge = arrays["alone"].shape[1], len(arrays["pair_out.bias"])
    layers = sum(name.endswith("norm2.bias") for name in arrays)
    net = RoutingNet(width, edge, len(arrays["layers.0.bias.bias"]), layers)
    net.load_state_dict(
        {
            name: torch.from_numpy(arrays[name].copy()) if name in arrays else matrices.pop(0)
            for name in net.state_dict()
        }
    )
    return net
