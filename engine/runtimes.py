"""What runs the networks on the processor: ONNX Runtime where it is installed, else OpenCV.

OpenCV comes with Involute and always works. ONNX Runtime computes the same to a millionth in 0.85
of the processor time; it is taken wherever Python can import it. (OpenVINO was as fast, at more
than twice the size.) The environment variable INVOLUTE_RUNTIME holds one of the names to force it.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cache, partial
from importlib.metadata import PackageNotFoundError, version
from threading import Lock
from time import perf_counter, process_time

import numpy as np

from . import phases
from .errors import InvoluteError
from .values import Array

VARIABLE = "INVOLUTE_RUNTIME"
SAME = 1e-5  # of a map in [0, 1], that two runtimes differ by at most
_TRIAL = 512  # px, the side of the page that a runtime is tried on

Net = Callable[[Mapping[str, Array], int], list[Array]]
"""Inputs by name -> the first so many outputs, in the file's order. Several threads may call it."""


@dataclass(frozen=True)
class Runtime:
    """name: as in INVOLUTE_RUNTIME. label: for people. package: what pip installs.
    load: the content of an ONNX file -> a network; raises ValueError when it is none."""

    name: str
    label: str
    package: str
    load: Callable[[bytes], Net]

    @property
    def version(self) -> str:
        try:
            return version(self.package)
        except PackageNotFoundError:  # in a Blender that brings it in another way
            return "?"


def _in_onnxruntime(content: bytes) -> Net:
    import cv2
    import onnxruntime

    onnxruntime.set_default_logger_severity(3)  # errors; they come as exceptions as well
    onnxruntime.disable_telemetry_events()
    options = onnxruntime.SessionOptions()
    # As many as OpenCV may use: who starts several processes has set that.
    options.intra_op_num_threads = max(1, cv2.getNumThreads())
    options.inter_op_num_threads = 1
    options.enable_mem_pattern = False  # windows are of many sizes
    options.enable_cpu_mem_arena = False  # memory goes back after each window
    options.add_session_config_entry("session.intra_op.allow_spinning", "0")
    try:
        session = onnxruntime.InferenceSession(content, options, ["CPUExecutionProvider"])
    except Exception as error:  # its own kinds, which can't be named without importing it
        raise ValueError(str(error)) from error
    names = [output.name for output in session.get_outputs()]

    def net(inputs: Mapping[str, Array], count: int) -> list[Array]:
        return list(session.run(names[:count], dict(inputs)))

    return net


def _in_opencv(content: bytes) -> Net:
    import cv2

    try:
        # From memory: OpenCV can't open every path that Python can.
        net = cv2.dnn.readNetFromONNX(np.frombuffer(content, np.uint8), engine=cv2.dnn.ENGINE_NEW)
    except cv2.error as error:
        raise ValueError(str(error)) from error
    running = Lock()
    names = net.getUnconnectedOutLayersNames()

    def infer(inputs: Mapping[str, Array], count: int) -> list[Array]:
        with running:  # a net holds the state of its last run
            for name, values in inputs.items():
                net.setInput(values, name)
            # All outputs or the first: OpenCV takes no other selection.
            return [net.forward()] if count == 1 else list(net.forward(names))[:count]

    return infer


def _in_phases(load: Callable[[bytes], Net], content: bytes) -> Net:
    """A network whose strides at its rim are worked outside of the runtime, where it has some."""
    taken = phases.in_phases(content)
    if taken is None:
        return load(content)
    net = load(taken.content)

    def infer(inputs: Mapping[str, Array], count: int) -> list[Array]:
        given = {
            name: phases.apart(values, taken.inputs[name]) if name in taken.inputs else values
            for name, values in inputs.items()
        }
        return [
            phases.together(answer, taken.outputs[name]) if name in taken.outputs else answer
            for name, answer in zip(taken.order, net(given, count), strict=False)
        ]

    return infer


RUNTIMES = tuple(
    Runtime(name, label, package, partial(_in_phases, load))
    for name, label, package, load in (
        ("onnxruntime", "ONNX Runtime", "onnxruntime", _in_onnxruntime),
        ("opencv", "OpenCV", "opencv-contrib-python-headless", _in_opencv),
    )
)


@cache
def here() -> tuple[Runtime, ...]:
    """The runtimes that work in this Python, the fastest first; the last one is OpenCV."""
    found = list(RUNTIMES)
    try:
        import onnxruntime  # noqa: F401
    except Exception:  # missing, or broken: a runtime that can't be loaded costs nobody a drawing
        found.pop(0)
    return tuple(found)


def chosen() -> Runtime:
    """The runtime that is used.

    Raises:
        InvoluteError: INVOLUTE_RUNTIME asks for one that isn't here.
    """
    asked = os.environ.get(VARIABLE, "")
    names = [runtime.name for runtime in here()]
    if asked and asked not in names:
        raise InvoluteError(
            f"{VARIABLE} is {asked!r}, and here is only {' and '.join(names)}; install it, or "
            "leave the variable empty."
        )
    return here()[names.index(asked) if asked else 0]


def load(content: bytes) -> Net:
    """The network in the content of an ONNX file, in the chosen runtime.

    Raises:
        ValueError: it holds none.
        InvoluteError: as `chosen`.
    """
    return chosen().load(content)


def seconds(runtime: Runtime, content: bytes, name: str) -> tuple[float, float]:
    """Processor seconds and seconds that a network takes for a megapixel, with warm caches.

    Args:
        name: of its one input, (1, 1, H, W) float32.
    """
    net = runtime.load(content)
    page = {name: np.random.default_rng(0).random((1, 1, _TRIAL, _TRIAL), np.float32)}
    net(page, 1)
    cpu, wall = process_time(), perf_counter()
    net(page, 1)
    megapixels = _TRIAL**2 / 1e6
    return (process_time() - cpu) / megapixels, (perf_counter() - wall) / megapixels
