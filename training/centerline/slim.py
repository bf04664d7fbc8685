"""Leave out of a trained centerline network what it does not use; the maps stay as they are.

    python -m involute.training.centerline.slim --weights FULL.onnx --pages DIR [DIR ...]
                                                --out engine/weights/centerline.onnx

The pages are held-out ones (`synthesis.held_out_pages`); on them is measured

    which channels hardly ever act (training leaves many behind in the deep layers): they go;
    in how few channels the answer of a transposed convolution can be said, as far as the
    convolution after it listens: by a singular value decomposition, no activation being between.

Without torch. Knows networks of convolutions whose answers are put side by side.
"""

from __future__ import annotations

import argparse
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import replace
from itertools import chain
from pathlib import Path

import cv2
import numpy as np
from involute.engine import Settings, onnx_file, runtimes
from involute.engine.centerline.backends import INPUT
from involute.engine.centerline.learned import STRIDE
from involute.engine.onnx_file import Network, Node
from involute.engine.scan import read_scan

from .. import digests

# Root of the share of the energy that a convolution is fed. At these the maps of four held-out
# pages changed by 0.004 at most; channels given up at 0.03 changed them by 0.37.
IDLE, UNHEARD = 0.01, 0.003
# Channels are kept in whole blocks: what the runtimes compute at a time anyway.
BLOCK = 16
_SIDE = 768  # px of a page that are looked at, which bounds the memory
_KINDS = frozenset({"Concat", "Conv", "ConvTranspose", "Relu", "Sigmoid"})

Moments = Mapping[str, np.ndarray]
"""Kernel -> (C, C), the mean products of the channels of what its convolution hands on."""
Channel = tuple[str, int]
"""Of which kernel's answer, and the how many-eth."""


def main(arguments: list[str] | None = None) -> None:
    """The command line."""
    parser = argparse.ArgumentParser(prog="slim", description=__doc__.splitlines()[0])
    parser.add_argument("--weights", type=Path, required=True)
    parser.add_argument("--pages", type=Path, nargs="+", required=True)
    parser.add_argument("--out", type=Path, required=True)
    options = parser.parse_args(arguments)
    if options.out.resolve() == options.weights.resolve():
        parser.error("--out: keep the whole network, and give the slim one another name")
    network = onnx_file.read(options.weights.read_bytes()).without_casts()
    slimmed = slim(network, measured(network, chain(_inks(options.pages), _unlike_pages())))
    options.out.write_bytes(onnx_file.write(slimmed, halve=True))
    digests.note(options.out, slimmed_from=options.weights)
    print(f"{_count(network)} -> {_count(slimmed)} weights")


def slim(network: Network, moments: Moments) -> Network:
    """A network without what it does not use."""
    return in_fewer(without_idle(network, moments), moments)


def measured(network: Network, inks: Iterable[np.ndarray]) -> dict[str, np.ndarray]:
    """What the channels of a network do on pages, (H, W) float32 ink in [0, 1].

    Raises:
        ValueError: the network is of another kind.
    """
    unknown = {node.kind for node in network.nodes} - _KINDS
    if unknown:
        raise ValueError(f"no network of convolutions side by side: {', '.join(sorted(unknown))}")
    names = {_handed_on(network, node): node.inputs[1] for node in _convolutions(network)}
    watched = replace(network, outputs=list(names))
    net = runtimes.RUNTIMES[-1].load(onnx_file.write(watched))
    sums: dict[str, np.ndarray] = {}
    for count, ink in enumerate(inks, 1):
        part = ink[: min(_SIDE, ink.shape[0] // STRIDE * STRIDE)]
        part = part[:, : min(_SIDE, ink.shape[1] // STRIDE * STRIDE)]
        answers = net({INPUT: np.ascontiguousarray(part)[None, None]}, len(names))
        for kernel, answer in zip(names.values(), answers, strict=True):
            flat = answer[0].reshape(answer.shape[1], -1)
            product = (flat @ flat.T).astype(float) / flat.shape[1]
            sums[kernel] = sums.get(kernel, np.zeros_like(product)) + product
        print(count, end=" ", flush=True)
    return sums


def without_idle(network: Network, moments: Moments) -> Network:
    """The network without the channels that nothing would miss."""
    heard: dict[Channel, float] = {}
    for node in _convolutions(network):
        origin = _origins(network, node.inputs[0])
        if not origin:
            continue
        strength = np.square(_kernel(network, node)).sum((0, 2, 3))
        energy = strength * [moments[kernel][k, k] for kernel, k in origin]
        for channel, share in zip(origin, energy / energy.sum(), strict=True):
            heard[channel] = max(heard.get(channel, 0.0), share)
    kept = {
        name: _kept(np.array([share for (of, _), share in sorted(heard.items()) if of == name]))
        for name in {of for of, _ in heard}
    }
    weights = dict(network.weights)
    for node in _convolutions(network):
        kernel, origin = _kernel(network, node), _origins(network, node.inputs[0])
        if origin:
            kernel = kernel[:, [c in kept[name] for name, c in origin]]
        if node.inputs[1] in kept:
            own = sorted(kept[node.inputs[1]])
            kernel = kernel[own]
            weights[node.inputs[2]] = weights[node.inputs[2]][own]
        weights[node.inputs[1]] = _as_stored(node, kernel)
    return replace(network, weights=weights)


def _kept(shares: np.ndarray) -> set[int]:
    """The channels that are kept of a layer, whose shares of what is heard these are."""
    order = np.argsort(-shares, kind="stable")
    rest = np.sqrt(np.cumsum(shares[order][::-1])[::-1])  # what would be lost from each on
    count = _in_blocks(int((rest > IDLE).sum()), len(shares))
    return set(order[:count].tolist())


def in_fewer(network: Network, moments: Moments) -> Network:
    """The network with the answers of transposed convolutions in as few channels as will do.

    `moments` are those of the whole network; of what has gone since nothing was heard.
    """
    weights = dict(network.weights)
    for node in _convolutions(network):
        reader = _only_reader(network, node)
        width = _width(network, node)
        if node.kind != "ConvTranspose" or reader is None or len(moments[node.inputs[1]]) != width:
            continue
        listener = _kernel(replace(network, weights=weights), reader)
        origin = _origins(network, reader.inputs[0])
        own = np.array([name == node.inputs[1] for name, _ in origin])
        to, spoken = _said_in_fewer(listener[:, own], moments[node.inputs[1]])
        if len(to) == width:
            continue
        kernel = _kernel(network, node)
        weights[node.inputs[1]] = _as_stored(node, np.einsum("rk,kcyx->rcyx", to, kernel))
        weights[node.inputs[2]] = (to @ weights[node.inputs[2]]).astype(np.float32)
        # They come last in what is put side by side; see `_only_reader`.
        weights[reader.inputs[1]] = np.concatenate([listener[:, ~own], spoken], 1)
    return replace(network, weights=weights)


def _said_in_fewer(listener: np.ndarray, moments: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """(R, C), which makes C channels R, and the listening kernel for those, (out, R, h, w)."""
    out, width, *size = listener.shape
    taps = listener.transpose(0, 2, 3, 1).reshape(-1, width).astype(float)
    values, vectors = np.linalg.eigh(moments)
    spread = vectors * np.sqrt(np.maximum(values, 0))
    left, strength, _ = np.linalg.svd(taps @ spread, full_matrices=False)
    lost = np.sqrt(np.cumsum(strength[::-1] ** 2)[::-1] / np.square(strength).sum())
    rank = min(_in_blocks(int((lost > UNHEARD).sum()), width), len(strength))
    spoken = left[:, :rank].reshape(out, *size, rank).transpose(0, 3, 1, 2)
    return left[:, :rank].T @ taps, spoken.astype(np.float32)


def _in_blocks(count: int, most: int) -> int:
    return min(most, -(-max(1, count) // BLOCK) * BLOCK)


def _convolutions(network: Network) -> list[Node]:
    return [node for node in network.nodes if node.kind in ("Conv", "ConvTranspose")]


def _kernel(network: Network, node: Node) -> np.ndarray:
    """(out, in, h, w), of a transposed convolution, too."""
    kernel = network.weights[node.inputs[1]]
    return kernel if node.kind == "Conv" else kernel.swapaxes(0, 1)


def _as_stored(node: Node, kernel: np.ndarray) -> np.ndarray:
    stored = kernel if node.kind == "Conv" else kernel.swapaxes(0, 1)
    return np.ascontiguousarray(stored, np.float32)


def _width(network: Network, node: Node) -> int:
    """How many channels a convolution hands on."""
    return len(network.weights[node.inputs[2]])


def _readers(network: Network, value: str) -> list[Node]:
    return [node for node in network.nodes if value in node.inputs]


def _handed_on(network: Network, node: Node) -> str:
    """What comes of a convolution: its answer, or what an activation makes of it."""
    readers = _readers(network, node.outputs[0])
    if len(readers) == 1 and readers[0].kind in ("Relu", "Sigmoid"):
        return readers[0].outputs[0]
    return node.outputs[0]


def _only_reader(network: Network, node: Node) -> Node | None:
    """The convolution that alone listens to a transposed one, which is put behind another value."""
    readers = _readers(network, node.outputs[0])
    if len(readers) != 1 or readers[0].kind != "Concat":
        return None
    if readers[0].inputs[-1] != node.outputs[0]:
        return None
    after = _readers(network, readers[0].outputs[0])
    return after[0] if len(after) == 1 and after[0].kind == "Conv" else None


def _origins(network: Network, value: str) -> list[Channel]:
    """The channels of a value, by the convolutions that they are from; none for an input."""
    node = next((n for n in network.nodes if n.outputs[0] == value), None)
    if node is None:
        return []
    if node.kind in ("Conv", "ConvTranspose"):
        return [(node.inputs[1], k) for k in range(_width(network, node))]
    return [channel for name in node.inputs for channel in _origins(network, name)]


def _inks(folders: Iterable[Path]) -> Iterator[np.ndarray]:
    """The ink of all pages in some folders."""
    for folder in folders:
        for path in sorted(folder.iterdir()):
            if path.suffix in (".png", ".jpg"):
                yield read_scan(path, Settings()).ink


def _unlike_pages() -> Iterator[np.ndarray]:
    """Noise, blobs, a chessboard and large solids: what is no drawing has its channels, too."""
    rng = np.random.default_rng(5)
    yield rng.random((_SIDE, _SIDE), np.float32)
    blobs = cv2.GaussianBlur(rng.normal(size=(_SIDE, _SIDE)), (0, 0), 3)
    yield (blobs < 0).astype(np.float32)
    yield np.kron(np.indices((_SIDE // 6, _SIDE // 6)).sum(0) % 2, np.ones((6, 6))).astype("f4")
    solids = np.zeros((_SIDE, _SIDE), np.float32)
    cv2.circle(solids, (400, 350), 220, 1.0, -1)
    cv2.rectangle(solids, (10, 10), (120, 600), 0.6, -1)
    yield solids


def _count(network: Network) -> int:
    return sum(values.size for values in network.weights.values())


if __name__ == "__main__":
    main()
