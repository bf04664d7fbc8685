"""The mean of two networks, one of which was trained on from the other: between old and new pages.

python -m involute.training.centerline.average A.onnx RUN/checkpoint.pt --out mean.onnx
"""

from __future__ import annotations

import argparse
import copy
from pathlib import Path

from .export_centerline import export, worst_difference
from .restore_unet import restored
from .unet import CenterlineNet


def main(arguments: list[str] | None = None) -> None:
    """The command line."""
    parser = argparse.ArgumentParser(prog="average", description=__doc__.splitlines()[0])
    parser.add_argument("networks", type=Path, nargs=2, help="checkpoints or ONNX files")
    parser.add_argument("--out", type=Path, required=True)
    options = parser.parse_args(arguments)
    net = average(*(restored(path) for path in options.networks))
    export(net, options.out)
    print(f"OpenCV against torch: {worst_difference(net, options.out):.1e}")


def average(one: CenterlineNet, other: CenterlineNet) -> CenterlineNet:
    """The network in the middle; both have the same layers and no norms."""
    theirs = other.state_dict()
    mean = {name: (value + theirs[name]) / 2 for name, value in one.state_dict().items()}
    net = copy.deepcopy(one)
    net.load_state_dict(mean)
    return net


if __name__ == "__main__":
    main()
