"""What runs the network: the processor (`runtimes`), or a GPU where torch is installed as well."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from importlib.util import find_spec
from pathlib import Path

from .. import onnx_file, runtimes
from .. import weights as shipped
from ..errors import InvoluteError
from ..values import Array
from .near_ink import near_ink

Infer = Callable[[Array], Array]
"""(h, w) float32 ink in [0, 1] -> (C, h, w) float32; h and w are multiples of the stride."""
InferBoth = Callable[[Array], tuple[Array, Array]]
"""The same, and beside the maps the features they are made of, (F, h / 2, w / 2) float32."""

INPUT = "ink"  # what the network calls it
_Run = Callable[[Array, int], list[Array]]  # ink -> the first so many outputs


def load(weights: Path, device: str) -> Infer:
    """The network in a file, on a device; loaded once per process and runtime.

    Raises:
        InvoluteError: the file is missing or broken, or there is no GPU though one is asked for.
    """
    return _for_maps(weights, device, runtimes.chosen().name)


def load_both(weights: Path, device: str) -> InferBoth:
    """The same network as `load` gives, with its features.

    Raises:
        InvoluteError: as `load`; or when called: the weights are older and have no features.
    """
    return _for_both(weights, device, runtimes.chosen().name)


@cache
def _for_maps(weights: Path, device: str, runtime: str) -> Infer:
    run = _loaded(weights, device, runtime)
    return lambda ink: run(ink, 1)[0]


@cache
def _for_both(weights: Path, device: str, runtime: str) -> InferBoth:
    run = _loaded(weights, device, runtime)

    def infer(ink: Array) -> tuple[Array, Array]:
        answers = run(ink, 2)
        if len(answers) < 2:
            raise InvoluteError(f"The weights in {weights.name} have no features; use newer ones.")
        return answers[0], answers[1]

    return infer


@cache
def _loaded(weights: Path, device: str, runtime: str) -> _Run:
    if not weights.exists():
        raise InvoluteError(
            f"The weights of the centerline network ({weights.name}) are missing; reinstall "
            "Involute, or choose the classical provider."
        )
    gpu = None if device == "cpu" else _torch_gpu()
    if gpu:
        return _torch(weights, gpu)
    if device == "gpu":
        raise InvoluteError("Found no GPU that torch can use; choose the device 'auto' or 'cpu'.")
    return _on_processor(weights)


def _on_processor(weights: Path) -> _Run:
    """The maps alone are made by looking at white paper as little as can be."""
    try:
        content = shipped.read(weights)
        everywhere = runtimes.load(content)
        look = near_ink(onnx_file.read(content).without_casts(), runtimes.load)
    except ValueError as error:
        raise InvoluteError(f"Can't read the weights in {weights.name}.") from error

    def run(ink: Array, count: int) -> list[Array]:
        page = ink[None, None]
        answers = [look(page)] if count == 1 else everywhere({INPUT: page}, count)
        return [answer[0] for answer in answers]

    return run


def _torch_gpu() -> str | None:
    """The GPU that torch offers, or None."""
    if find_spec("torch") is None:
        return None
    import torch

    if torch.cuda.is_available():
        return "cuda"
    return "mps" if torch.backends.mps.is_available() else None


def _torch(weights: Path, device: str) -> _Run:
    import torch

    from .onnx_torch import module

    net = module(shipped.read(weights)).to(device)

    def infer(ink: Array, count: int) -> list[Array]:
        with torch.inference_mode():
            answers = net.all_of(torch.from_numpy(ink[None, None]).to(device))
            return [answer[0].cpu().numpy() for answer in answers[:count]]

    return infer
