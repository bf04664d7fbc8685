"""Write the weights of a run as the ONNX file that the engine reads, and check it.

python -m involute.training.centerline.export_centerline
    --checkpoint RUN/checkpoint.pt --out centerline.onnx (or FILE.pt, to train on from)
"""

from __future__ import annotations

import argparse
import copy
import warnings
from pathlib import Path

import numpy as np
import onnx
import torch
from involute.engine.centerline.backends import load_both
from involute.engine.centerline.learned import STRIDE
from torch import nn
from torch.nn.utils.fusion import fuse_conv_bn_eval

from .. import digests
from .restore_unet import restored
from .unet import CenterlineNet, Exported

TOLERANCE = 1e-3
_ARRAYS = ("ink", "maps", "features")


def main(arguments: list[str] | None = None) -> None:
    """The command line."""
    parser = argparse.ArgumentParser(prog="export", description=__doc__.splitlines()[0])
    parser.add_argument("--checkpoint", type=Path, required=True)
    parser.add_argument("--out", type=Path, required=True)
    options = parser.parse_args(arguments)
    net = restored(options.checkpoint)
    if options.out.suffix == ".pt":
        keep(net, options.out)
        return
    export(net, options.out)
    digests.note(options.out, options.checkpoint.parent)
    print(f"{options.out.name}: {options.out.stat().st_size / 1e6:.1f} MB")
    print(f"OpenCV against torch: {worst_difference(net, options.out):.1e}")


def keep(net: CenterlineNet, out: Path) -> None:
    """Write the weights, norms and all, as 16 bit: for `train_centerline --start-from`."""
    state = net.state_dict().items()
    torch.save({"mean": {k: v.half() if v.is_floating_point() else v for k, v in state}}, out)


def folded(net: CenterlineNet) -> CenterlineNet:
    """The network with its normalisation folded into the weights, and these rounded to 16 bit."""
    net = copy.deepcopy(net).eval()
    for layer in net.modules():
        if isinstance(layer, nn.Sequential) and len(layer) and isinstance(layer[-1], nn.ReLU):
            if isinstance(layer[1], nn.Identity):
                continue
            layer[0] = fuse_conv_bn_eval(layer[0], layer[1])
            layer[1] = nn.Identity()
    for weight in net.parameters():
        weight.data = weight.data.half().float()
    return net


def export(net: CenterlineNet, out: Path) -> None:
    """Write the network with its final activation, weights as 16 bit."""
    part = out.with_suffix(".part")
    with warnings.catch_warnings():
        # The newer exporter needs another package and gains nothing for plain convolutions.
        warnings.simplefilter("ignore")
        torch.onnx.export(
            Exported(folded(net)).eval(),
            (torch.zeros(1, 1, 8 * STRIDE, 8 * STRIDE),),
            str(part),
            dynamo=False,
            opset_version=17,
            input_names=["ink"],
            output_names=["maps", "features"],
            dynamic_axes={name: {2: f"{name}_h", 3: f"{name}_w"} for name in _ARRAYS},
        )
    _halve(part)
    part.replace(out)


def _halve(path: Path) -> None:
    """Store the weights as 16-bit numbers; whoever reads them casts them back."""
    model = onnx.load(path)
    graph = model.graph
    casts = []
    for weight in graph.initializer:
        name = weight.name
        small = onnx.numpy_helper.to_array(weight).astype(np.float16)
        weight.CopyFrom(onnx.numpy_helper.from_array(small, f"{name}.half"))
        casts.append(
            onnx.helper.make_node("Cast", [weight.name], [name], to=onnx.TensorProto.FLOAT)
        )
    nodes = [*casts, *graph.node]
    del graph.node[:]
    graph.node.extend(nodes)
    onnx.save(model, path)


def worst_difference(net: CenterlineNet, weights: Path) -> float:
    """The largest difference between OpenCV and torch over random lines; features count relative
    to the largest of them.

    Raises:
        ValueError: it is more than TOLERANCE.
    """
    rng = np.random.default_rng(1)
    stride = 2 ** len(net.encode)
    ink = np.maximum(0, rng.normal(0, 0.02, (11 * stride, 9 * stride))).astype(np.float32)
    ink[rng.integers(0, len(ink), 6)] = 1.0
    seen = load_both(weights, "cpu")(ink)
    with torch.inference_mode():
        wanted = [a[0].numpy() for a in Exported(folded(net))(torch.from_numpy(ink[None, None]))]
    scales = 1.0, max(1.0, float(wanted[1].max()))
    worst = max(
        float(np.abs(a - b).max()) / scale for a, b, scale in zip(seen, wanted, scales, strict=True)
    )
    if worst > TOLERANCE:
        raise ValueError(f"OpenCV and torch differ by {worst:.1e}.")
    return worst


if __name__ == "__main__":
    main()
