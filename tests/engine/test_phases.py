"""Strides at the rim of a network as phases: the same answers, and the time that they are for."""

from __future__ import annotations

import cv2
import numpy as np
import pytest
from involute.engine import onnx_file, phases, runtimes, weights
from involute.engine.centerline import backends, learned

SAME = 2e-6  # of a map in [0, 1], and of features relative to the largest of them


def plain(content: bytes, ink: np.ndarray) -> list[np.ndarray]:
    """What OpenCV answers to the network as it is."""
    net = cv2.dnn.readNetFromONNX(np.frombuffer(content, np.uint8), engine=cv2.dnn.ENGINE_NEW)
    net.setInput(ink, backends.INPUT)
    return list(net.forward(net.getUnconnectedOutLayersNames()))


def lines(height: int, width: int) -> np.ndarray:
    """(1, 1, height, width) ink with lines up to its rim, and some grain."""
    rng = np.random.default_rng(4)
    ink = np.zeros((height, width), np.float32)
    for a, b in rng.integers(0, (width, height), (8, 2, 2)).tolist():
        cv2.line(ink, a, b, 1.0, 3, cv2.LINE_AA)
    grain = rng.normal(0, 0.02, ink.shape).astype(np.float32)
    return np.clip(ink + grain, 0, 1)[None, None]


def test_phases_come_apart_and_together():
    image = np.arange(2 * 6 * 9, dtype=np.float32).reshape(1, 2, 6, 9)
    taken = phases.apart(image, 3)
    assert taken.shape == (1, 18, 2, 3)
    np.testing.assert_array_equal(taken[0, 0], image[0, 0, ::3, ::3])
    np.testing.assert_array_equal(taken[0, 2 * (3 * 1 + 2) + 1], image[0, 1, 1::3, 2::3])
    np.testing.assert_array_equal(phases.together(taken, 3), image)


@pytest.mark.parametrize("path", [learned.WEIGHTS, learned.LEAN], ids=lambda path: path.stem)
@pytest.mark.parametrize("size", [(16, 16), (80, 144)])
def test_the_shipped_networks_answer_the_same(path, size):
    content = weights.read(path)
    taken = phases.in_phases(content)
    assert taken is not None
    assert taken.inputs == {"ink": 2}
    assert taken.outputs == {"maps": 2}
    ink = lines(*size)
    expected = plain(content, ink)
    found = runtimes.RUNTIMES[-1].load(content)({backends.INPUT: ink}, len(expected))
    assert len(found) == len(expected)
    for one, other in zip(found, expected, strict=True):
        scale = max(1.0, float(other.max()))
        np.testing.assert_allclose(one / scale, other / scale, rtol=0, atol=SAME)
    (maps,) = runtimes.RUNTIMES[-1].load(content)({backends.INPUT: ink}, 1)
    np.testing.assert_array_equal(maps, found[0])


@pytest.mark.parametrize("path", [learned.WEIGHTS, learned.LEAN], ids=lambda path: path.stem)
def test_no_strided_convolution_is_left_at_the_rim(path):
    taken = phases.in_phases(weights.read(path))
    assert taken is not None
    network = onnx_file.read(taken.content)
    by_input = [node for node in network.nodes if set(network.inputs) & set(node.inputs)]
    ends = [node for node in network.nodes if node.outputs[0].startswith("/net/head")]
    for node in by_input + ends:
        assert (node.kind, node.attributes["strides"]) == ("Conv", [1, 1])


def test_other_networks_are_left_alone():
    assert phases.in_phases(weights.read(weights.FOLDER / "routing.onnx")) is None


def test_a_network_that_is_written_is_read_as_it_was():
    node = onnx_file.Node(
        "Conv", ["ink", "w", "b"], ["maps"],
        {"dilations": [1, 1], "group": [1], "kernel_shape": [3, 3], "pads": [1] * 4,
         "strides": [1, 1]},
    )  # fmt: skip
    kernel = np.random.default_rng(0).normal(size=(2, 1, 3, 3)).astype(np.float32)
    held = {"w": kernel, "b": np.array([0.5, -300], np.float32)}
    network = onnx_file.Network([node], held, ["ink"], ["maps"])
    content = onnx_file.write(network)
    found = onnx_file.read(content)
    assert (found.nodes, found.inputs, found.outputs) == ([node], ["ink"], ["maps"])
    for name, values in held.items():
        np.testing.assert_array_equal(found.weights[name], values)
    ink = lines(20, 30)
    expected = cv2.filter2D(ink[0, 0], -1, kernel[1, 0], borderType=cv2.BORDER_CONSTANT) - 300
    (maps,) = plain(content, ink)
    np.testing.assert_allclose(maps[0, 1], expected, atol=1e-4)
