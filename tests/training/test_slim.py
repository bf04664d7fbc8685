"""Slimming a network: what it does not use goes, and it answers as before."""

from __future__ import annotations

import numpy as np
import pytest
from involute.engine import onnx_file, runtimes, weights
from involute.engine.centerline.backends import INPUT
from involute.engine.centerline.learned import LEAN
from involute.engine.onnx_file import Network, Node
from involute.training import lineage
from involute.training.centerline import slim

ACTING = 20  # of the 64 channels of the first layer
RANK = 3  # of the 32 channels of what is put beside it


def convolution(kind: str, source: str, name: str, size: int, step: int, pads: int) -> Node:
    attributes = {
        "dilations": [1, 1], "group": [1], "kernel_shape": [size, size],
        "pads": [pads] * 4, "strides": [step, step],
    }  # fmt: skip
    return Node(kind, [source, f"{name}.w", f"{name}.b"], [name], attributes)


@pytest.fixture
def network() -> Network:
    """A little U: two thirds of its deep channels never act, and what comes back up has rank 3."""
    rng = np.random.default_rng(2)

    def kernel(*shape: int) -> np.ndarray:
        return rng.normal(0, 1 / np.sqrt(np.prod(shape[1:])), shape).astype(np.float16)

    up = np.einsum("kr,rcyx->kcyx", kernel(64, RANK).astype("f4"), kernel(RANK, 32, 2, 2))
    held = {
        "stem.w": kernel(16, 1, 3, 3), "stem.b": np.full(16, 0.1),
        "deep.w": kernel(64, 16, 2, 2), "deep.b": np.where(np.arange(64) < ACTING, 0.5, -9.0),
        "up.w": up, "up.b": np.zeros(32),
        "last.w": kernel(8, 48, 3, 3), "last.b": np.zeros(8),
    }  # fmt: skip
    nodes = [
        convolution("Conv", INPUT, "stem", 3, 1, 1), Node("Relu", ["stem"], ["stem+"], {}),
        convolution("Conv", "stem+", "deep", 2, 2, 0), Node("Relu", ["deep"], ["deep+"], {}),
        convolution("ConvTranspose", "deep+", "up", 2, 2, 0),
        Node("Concat", ["stem+", "up"], ["both"], {"axis": [1]}),
        convolution("Conv", "both", "last", 3, 1, 1), Node("Sigmoid", ["last"], ["maps"], {}),
    ]  # fmt: skip
    stored = {name: np.asarray(values, np.float32) for name, values in held.items()}
    return Network(nodes, stored, [INPUT], ["maps"])


@pytest.fixture
def inks() -> list[np.ndarray]:
    return list(np.random.default_rng(3).random((3, 64, 48), np.float32))


def test_what_never_acts_goes_and_little_is_said_in_few_channels(network, inks):
    slimmed = slim.slim(network, slim.measured(network, inks))
    shapes = {name: values.shape for name, values in slimmed.weights.items()}
    assert shapes["deep.w"] == (32, 16, 2, 2)  # the 20 that act, in whole blocks
    assert shapes["deep.b"] == (32,)
    assert shapes["up.w"] == (32, slim.BLOCK, 2, 2)
    assert shapes["last.w"] == (8, 16 + slim.BLOCK, 3, 3)
    kept = set(slimmed.weights["deep.b"].tolist())
    assert kept >= {0.5}
    assert (slimmed.weights["deep.b"] == 0.5).sum() == ACTING
    page = np.random.default_rng(4).random((1, 1, 32, 64), np.float32)
    answers = [
        runtimes.RUNTIMES[-1].load(onnx_file.write(net))({INPUT: page}, 1)[0]
        for net in (network, slimmed)
    ]
    np.testing.assert_allclose(*answers, atol=2e-3)
    assert answers[0].std() > 0.05


def test_a_network_that_uses_everything_stays_as_it_is(inks, network):
    rng = np.random.default_rng(5)
    network.weights["deep.b"][:] = 0.5
    network.weights["up.w"][:] = rng.normal(0, 0.1, network.weights["up.w"].shape)
    slimmed = slim.slim(network, slim.measured(network, inks))
    for name, values in network.weights.items():
        np.testing.assert_array_equal(slimmed.weights[name], values)


def test_short_weights_are_stored_short(network):
    network.weights["last.w"][0, 0, 0, 0] = 1 / 3  # no 16-bit number
    content = onnx_file.write(network, halve=True)
    found = onnx_file.read(content)
    assert {node.outputs[0] for node in found.nodes if node.kind == "Cast"} >= {"stem.w", "deep.w"}
    assert "last.w" in found.weights
    for name, values in network.weights.items():
        np.testing.assert_array_equal(found.without_casts().weights[name], values)


def test_networks_of_another_kind_are_refused(inks):
    lean = onnx_file.read(weights.read(LEAN)).without_casts()
    with pytest.raises(ValueError, match="Add"):
        slim.measured(lean, inks)


def test_the_command_notes_which_weights_it_slimmed(network, inks, tmp_path, monkeypatch):
    whole, out = tmp_path / "whole.onnx", tmp_path / "shipped" / "slim.onnx"
    out.parent.mkdir()
    (out.parent / weights.DIGESTS).write_text("{}", "utf-8")
    whole.write_bytes(onnx_file.write(network))
    monkeypatch.setattr(slim, "_inks", lambda folders: iter(inks))
    slim.main(["--weights", str(whole), "--pages", str(tmp_path), "--out", str(out)])
    assert lineage.read(out.parent)["slim.onnx"]["slimmed_from"]["file"] == "whole.onnx"
    assert len(onnx_file.read(out.read_bytes()).without_casts().weights["deep.b"]) < 64
    with pytest.raises(SystemExit):
        slim.main(["--weights", str(whole), "--pages", str(tmp_path), "--out", str(whole)])
