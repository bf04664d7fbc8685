"""A network read back: from the checkpoint of a run, or from shipped weights to train on from.

Shipped weights have their normalisation folded in; the network that they give has none, and biases
in its place.
"""

from __future__ import annotations

from pathlib import Path

import onnx
import torch
from onnx import numpy_helper
from torch import nn

from .unet import HEADS, CenterlineNet


def restored(path: Path) -> CenterlineNet:
    """The network of a checkpoint (the running mean of its weights) or of an ONNX file of `export`,
    ready for inference; older ones have fewer heads."""
    state = _shipped(path) if path.suffix == ".onnx" else torch.load(path, "cpu")["mean"]
    deeper = sum(name.startswith("down.") and name.endswith(".0.weight") for name in state)
    widths = [len(state["stem.0.weight"])]
    widths += [len(state[f"down.{k}.0.weight"]) for k in range(deeper)]
    counts = [
        sum(f"encode.{level}.{k}.0.weight" in state for k in range(len(state)))
        for level in range(deeper + 1)
    ]
    net = CenterlineNet(tuple(widths), tuple(counts), norms="stem.0.bias" not in state).eval()
    inputs, heads, *_ = state["head.weight"].shape
    if heads < len(HEADS):
        net.head = nn.ConvTranspose2d(inputs, heads, 4, 2, 1)
    net.load_state_dict(state)
    return net


def with_all_heads(net: CenterlineNet) -> CenterlineNet:
    """The network with those of HEADS that it lacks, new ones, to be trained on."""
    old, known = net.head, net.head.out_channels
    if known < len(HEADS):
        net.head = nn.ConvTranspose2d(old.in_channels, len(HEADS), 4, 2, 1)
        nn.init.constant_(net.head.bias, -3.0)
        with torch.no_grad():
            net.head.weight[:, :known], net.head.bias[:known] = old.weight, old.bias
    return net


def _shipped(path: Path) -> dict[str, torch.Tensor]:
    """Weights by their name in the network; `export` has wrapped it and stored 16-bit numbers."""
    return {
        array.name.removeprefix("net.").removesuffix(".half"): torch.from_numpy(
            numpy_helper.to_array(array).astype("float32")
        )
        for array in onnx.load(str(path)).graph.initializer
    }
