"""The finest layers of a network only where there is ink.

More than half of the work is done on the finest levels, those a network begins and ends with, and
most of a page is white. To these layers white paper is the same everywhere, so what they say of it
is known. They are cut off from the rest of the network and look at rectangles around the ink; the
rest looks at everything. Near the ink the answer is the same, to the bit in OpenCV.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import cv2
import numpy as np

from .. import onnx_file
from ..onnx_file import Network, Node
from ..values import Array

Net = Callable[[Mapping[str, Array], int], list[Array]]
Load = Callable[[bytes], Net]
Look = Callable[[Array, Array], Array]
"""(1, C, h, w) and the cells of CELL px, bool, where an answer is wanted -> (1, D, h, w)."""

Edges = tuple[int, int, int, int]  # top, left, bottom, right

CELL = 16  # px; where there is ink is asked of cells of this size
NEAR = 8  # px from the ink that maps are wanted: no line runs farther away
_LEVELS = 2  # that are cut off; below them a rectangle is mostly rim
_PROBE = 64  # px, the side of the blank paper that is looked at to know what is said of it
_CALL = 800  # px that would be looked at in the time that a rectangle costs beside its own
_WORTH = 0.85  # of a window that the rectangles cost at most, or it is looked at as a whole


@dataclass(frozen=True)
class Cut:
    """A network in three. before: input -> what `after` wants of it, and what `rest` wants; rest:
    that -> its answer; after: the former and the answer -> the first output.

    rim: px of the input around a part of it that its answer depends on, as far as before and after
    look.
    """

    before: Network
    rest: Network
    after: Network
    rim: int


def cut(network: Network) -> Cut | None:
    """The network with its finest level cut off; None where it does not go down and up again."""
    made = {node.outputs[0]: node for node in network.nodes}
    joins = [
        node.inputs
        for node in network.nodes
        if node.kind in ("Add", "Concat") and node.inputs[1] in made
    ]
    if not joins:
        return None
    across, rises = joins[-1][0], made[joins[-1][1]]
    downs = [n for n in network.nodes if n.kind == "Conv" and n.inputs[0] == across]
    if rises.kind != "ConvTranspose" or len(downs) != 1:
        return None
    sunk = downs[0].outputs[0]
    acts = [n for n in network.nodes if n.kind == "Relu" and n.inputs[0] == sunk]
    sunk = acts[0].outputs[0] if acts else sunk
    before = _part(network, network.inputs, [across, sunk])
    rest = _part(network, [sunk], [rises.inputs[0]])
    after = _part(network, [across, rises.inputs[0]], network.outputs[:1])
    if not all(_is_closed(part) for part in (before, rest, after)):
        return None
    reach, step = _reach(before, {before.inputs[0]: (0, 1)}, sunk)
    _, fine = _reach(before, {before.inputs[0]: (0, 1)}, across)
    back, _ = _reach(after, {across: (0, fine), after.inputs[1]: (0, step)}, after.outputs[0])
    return Cut(before, rest, after, -(-max(reach, back) // step) * step)


def _part(network: Network, inputs: list[str], outputs: list[str]) -> Network:
    """What leads from some values of a network to others."""
    wanted, nodes = set(outputs), list[Node]()
    for node in reversed(network.nodes):
        if wanted.intersection(node.outputs) and not set(inputs).intersection(node.outputs):
            nodes.insert(0, node)
            wanted.update(node.inputs)
    weights = {name: values for name, values in network.weights.items() if name in wanted}
    return Network(nodes, weights, list(inputs), list(outputs))


def _is_closed(part: Network) -> bool:
    """Whether all that its layers want is made in it, or given to it."""
    known = {*part.inputs, *part.weights, *(name for node in part.nodes for name in node.outputs)}
    return all(known.issuperset(node.inputs) for node in part.nodes)


def _reach(network: Network, known: dict[str, tuple[int, int]], value: str) -> tuple[int, int]:
    """How many px around a pixel of a value it depends on, and how many px its pixels are apart;
    both are known of the inputs."""
    known = dict(known)
    for node in network.nodes:
        given = [known[name] for name in node.inputs if name in known]
        if not given:
            continue  # of weights alone
        reach, step = map(max, zip(*given, strict=True))
        strides, pads = (
            node.attributes.get(name, [k]) for name, k in (("strides", 1), ("pads", 0))
        )
        reach += max(pads) * step
        step = step // strides[0] if node.kind == "ConvTranspose" else step * strides[0]
        known[node.outputs[0]] = reach, step
    return known[value]


def near_ink(network: Network, load: Load) -> Callable[[Array], Array]:
    """A network that maps ink (1, 1, h, w) to maps (1, C, h, w), their sides multiples of CELL.

    Cells farther from ink than NEAR px, and than the finest level looks, are 0 in the maps.

    load: makes a network run, whole or in parts.
    """
    parts, whole = cut(network), _whole(network, load)
    blank = np.zeros((1, 1, _PROBE, _PROBE), np.float32)
    level = _Level(parts, load, blank, _LEVELS, whole) if parts else whole
    reach = max(NEAR, parts.rim if parts else 0)

    def look(ink: Array) -> Array:
        height, width = (side // CELL for side in ink.shape[2:])
        cells = _grown(ink[0, 0] > 0, reach).reshape(height, CELL, width, CELL).any((1, 3))
        maps = level(ink, cells)
        maps.reshape(-1, height, CELL, width, CELL).swapaxes(2, 3)[:, ~cells] = 0
        return maps

    return look


class _Level:
    """The layers of one level, and the rest of the network behind them: a `Look`."""

    def __init__(
        self, parts: Cut, load: Load, blank: Array, levels: int, whole: Look | None = None
    ) -> None:
        """blank: (1, C, h, w) what blank paper of _PROBE px is to this level; whole: all of it as
        one network."""
        self._all = whole or self._everywhere
        self._before, self._after = (load(onnx_file.write(p)) for p in (parts.before, parts.after))
        self._input, self._inputs = parts.before.inputs[0], parts.after.inputs
        self._rim, self._unit = parts.rim, _PROBE // blank.shape[2]
        self._blank = self._before({self._input: blank}, 2)
        self._steps = [blank.shape[2] // said.shape[2] for said in self._blank]
        inner = cut(parts.rest) if levels > 1 else None
        farthest = max(self._rim, inner.rim * self._steps[1] if inner else 0)
        self._around = -(-farthest * self._unit // CELL)  # cells that the rest is wanted of, too
        self._rest: Look = (
            _Level(inner, load, self._blank[1], levels - 1) if inner else _whole(parts.rest, load)
        )

    def __call__(self, image: Array, cells: Array) -> Array:
        size, (height, width) = CELL // self._unit, image.shape[2:]
        rectangles, cost = cover(cells, 2 * self._rim / size)
        small = min(height, width) * self._unit < _PROBE
        if small or not rectangles or cost > _WORTH * cells.size:
            return self._all(image, cells)
        windows = [_Window.of(rectangle, size, self._rim, image) for rectangle in rectangles]
        pages = [
            _paper(blank, height // step, width // step)
            for blank, step in zip(self._blank, self._steps, strict=True)
        ]
        for window in windows:
            answers = self._before({self._input: window.of_page(image)}, 2)
            for page, answer, step in zip(pages, answers, self._steps, strict=True):
                window.put(page, answer, step)
        across, sunk = pages
        risen = self._rest(sunk, _grown(cells, self._around))
        found: Array | None = None
        fine, coarse = self._steps
        for window in windows:
            answer = self._done(window.of_page(across, fine), window.of_page(risen, coarse))
            if found is None:
                found = np.zeros((1, answer.shape[1], height, width), np.float32)
            window.put(found, answer)
        assert found is not None  # there are rectangles
        return found

    def _everywhere(self, image: Array, cells: Array) -> Array:
        across, sunk = self._before({self._input: image}, 2)
        return self._done(across, self._rest(sunk, np.ones_like(cells)))

    def _done(self, across: Array, risen: Array) -> Array:
        return self._after(dict(zip(self._inputs, (across, risen), strict=True)), 1)[0]


def _whole(network: Network, load: Load) -> Look:
    """The rest of a network, which sees all there is."""
    net, (name,) = load(onnx_file.write(network)), network.inputs
    return lambda image, _: net({name: image}, 1)[0]


def _grown(place: Array, by: int) -> Array:
    """(h, w) bool: what is True, and all that is no farther away from it than that, either way."""
    return cv2.dilate(place.view(np.uint8), np.ones((2 * by + 1, 2 * by + 1), np.uint8)) > 0


def _paper(blank: Array, height: int, width: int) -> Array:
    """(1, C, height, width) what is said of blank paper of that size, of which `blank` is a small
    piece: the same everywhere but for its rim."""
    rim, middle = blank.shape[2] // 4, slice(blank.shape[2] // 2, blank.shape[2] // 2 + 1)
    paper = np.empty((*blank.shape[:2], height, width), np.float32)
    ends, inside = (slice(rim), slice(-rim, None)), slice(rim, -rim)
    paper[..., inside, inside] = blank[..., middle, middle]
    for end in ends:
        paper[..., end, inside] = blank[..., end, middle]
        paper[..., inside, end] = blank[..., middle, end]
        for other in ends:
            paper[..., end, other] = blank[..., end, other]
    return paper


@dataclass(frozen=True)
class _Window:
    """A rectangle, and what a level looks at for it; edges (top, left, bottom, right) in px."""

    own: Edges
    seen: Edges

    @staticmethod
    def of(cells: Edges, size: int, rim: int, image: Array) -> _Window:
        """The window around a rectangle of cells of so many px, as far as the image reaches."""
        top, left, bottom, right = (edge * size for edge in cells)
        height, width = image.shape[2:]
        around = max(0, top - rim), max(0, left - rim), bottom + rim, right + rim
        bottom, right = min(height, bottom), min(width, right)
        seen = around[0], around[1], min(height, around[2]), min(width, around[3])
        return _Window((top, left, bottom, right), seen)

    def of_page(self, page: Array, step: int = 1) -> Array:
        """What is seen of a page (1, C, h, w) that has a pixel for every so many px."""
        top, left, bottom, right = (edge // step for edge in self.seen)
        return np.ascontiguousarray(page[..., top:bottom, left:right])

    def put(self, page: Array, answer: Array, step: int = 1) -> None:
        """Write what belongs to the rectangle of an answer to what is seen into a page."""
        top, left, bottom, right = (edge // step for edge in self.own)
        up, before = self.seen[0] // step, self.seen[1] // step
        page[..., top:bottom, left:right] = answer[
            ..., top - up : bottom - up, left - before : right - before
        ]


def cover(cells: Array, rims: float) -> tuple[list[Edges], float]:
    """Disjoint rectangles over all cells that are True, and what they cost to look at, in cells.

    The page is halved, and its halves, across and along in turn; a part is looked at as one
    rectangle, as small as it can be, or as its own halves, whichever costs less.

    Args:
        cells: (h, w) bool. rims: cells that a window has more than its rectangle, either way.
    """
    side = 1 << max(1, max(cells.shape) - 1).bit_length()
    true = np.zeros((side, side), bool)
    true[: cells.shape[0], : cells.shape[1]] = cells
    down, right = np.indices(true.shape)
    # Top, left, -bottom and -right of what is True in a part: the least of two parts is of both.
    box = np.where(true[..., None], np.stack([down, right, -1 - down, -1 - right], -1), side)
    call = _CALL / CELL**2
    cost, halved = np.where(true, (1 + rims) ** 2 + call, 0.0), np.zeros_like(true)
    levels = [(box, cost, halved)]
    while len(cost) < cost.size or len(cost) > 1:
        axis = (len(levels) - 1) % 2
        pairs = [*cost.shape]
        pairs[axis : axis + 1] = [pairs[axis] // 2, 2]
        box = box.reshape(*pairs, 4).min(axis + 1)
        parts = cost.reshape(pairs).sum(axis + 1)
        whole = (-box[..., 2:] - box[..., :2] + rims).prod(-1) + call
        halved = parts < whole
        cost = np.where(halved, parts, whole)
        levels.append((box, cost, halved))

    found, parts = [], np.zeros((1, 2), int)
    for level in reversed(range(len(levels))):
        box, cost, halved = levels[level]
        parts = parts[cost[tuple(parts.T)] > 0]
        cutting = halved[tuple(parts.T)]
        found.append(box[tuple(parts[~cutting].T)])
        parts = np.repeat(parts[cutting], 2, axis=0)
        axis = (level - 1) % 2
        parts[:, axis] = 2 * parts[:, axis] + np.arange(len(parts)) % 2
    edges = np.concatenate(found) * [1, 1, -1, -1]
    return [tuple(edge) for edge in edges.tolist()], float(levels[-1][1].item())
