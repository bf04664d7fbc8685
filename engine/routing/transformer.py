"""The routing network in NumPy: what training/routing/set_transformer.py describes, on flat rows.

A page has junctions of 3 half-branches and few of more. A runtime for networks wants a table with
room for the most at every one of them; here those of one degree stand together, nothing is padded,
and the same sums (to rounding) take less time. The large matrix products are OpenCV's: NumPy's are
rounded otherwise by each number of threads, OpenCV's are the same for a row whatever is beside it.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from .. import onnx_file, runtimes
from ..onnx_file import Network, Node
from ..values import Array

_EPSILON = np.float32(1e-5)  # of torch's LayerNorm
_ROWS = 512  # multiplied at a time: they stay in the processor's cache, and bound the memory
# The matrices without a name in the file, in the order in which the network uses them.
_BEFORE = ("token.0", "token.2", "pair", "pair_from", "pair_to", "pair_out")
_LAYER = ("qkv", "bias", "out", "mix.0", "mix_out", "overview")
_AFTER = ("head_pair", "head_sum", "head_product", "score")


@dataclass(frozen=True, eq=False)
class _Group:
    """The n junctions with d half-branches.

    rows: (n,) their numbers; slots: (n, d) which slots they fill; at: where their half-branches
    begin among all; pairs: where their pairs do.
    """

    rows: Array
    slots: Array
    at: int
    pairs: int

    @property
    def shape(self) -> tuple[int, int]:
        return self.slots.shape[0], self.slots.shape[1]

    def halves(self, x: Array) -> Array:
        """(n, d, ...) of the (T, ...) rows of all half-branches: a view."""
        n, d = self.shape
        return x[self.at : self.at + n * d].reshape(n, d, *x.shape[1:])

    def of_pairs(self, e: Array) -> Array:
        """(n, d, d, ...) of the (P, ...) rows of all ordered pairs: a view."""
        n, d = self.shape
        return e[self.pairs : self.pairs + n * d * d].reshape(n, d, d, *e.shape[1:])


class Transformer:
    """The network; several threads may call it."""

    def __init__(self, content: bytes) -> None:
        """content: of routing.onnx, as `training/routing/export_routing.py` writes it.

        Raises:
            ValueError: it is no such network.
        """
        read = onnx_file.read(content)
        known = dict(read.weights)
        used = [n.inputs[1] for n in read.nodes if n.kind == "MatMul" and n.inputs[1] in known]
        layers = sum(name.endswith(".norm2.bias") for name in known)
        names = [*_BEFORE, *(f"layers.{k}.{n}" for k in range(layers) for n in _LAYER), *_AFTER]
        if not layers or len(used) != len(names):
            raise ValueError("this is no routing network")
        self._linears = {
            name: _Linear(known[m], known.get(f"{name}.bias"))
            for name, m in zip(names, used, strict=True)
        }
        self._weights: Mapping[str, Array] = known
        self._layers = layers
        self._heads = len(known["layers.0.bias.bias"])

    def __call__(self, tokens: Array, pairs: Array, sibling: Array, mask: Array) -> Array:
        """Score all pairs of a drawing.

        Args:
            tokens: (J, D, TOKEN_SIZE) float32; pairs: (J, D, D, PAIR_SIZE) float32.
            sibling: (J, D) flat slot of the other end of the branch; J * D = none.
            mask: (J, D), not 0 where a slot is filled.

        Returns:
            (J, D, D) float32 symmetric scores, before calibration; 0 where a slot is empty.
        """
        scores = np.zeros((*mask.shape, mask.shape[1]), np.float32)
        groups = _groups(mask > 0)
        if not groups:
            return scores
        flat = np.concatenate([(g.rows[:, None] * mask.shape[1] + g.slots).ravel() for g in groups])
        number = np.full(mask.size + 1, len(flat))
        number[flat] = np.arange(len(flat))
        other = number[sibling.reshape(-1)[flat]]

        x = self._linear("token.0", tokens.reshape(mask.size, -1)[flat])
        x = self._linear("token.2", np.maximum(x, 0, out=x))
        e = self._edges(x, pairs, groups)
        for layer in range(self._layers):
            x = self._layer(f"layers.{layer}.", x, e, groups, other)
            mean = x.mean(0, keepdims=True, dtype=np.float64).astype(np.float32)
            x += self._linear(f"layers.{layer}.overview", mean)
        found = self._scored(self._norm("last", x), e, groups)
        for g in groups:
            slots = g.slots
            scores[g.rows[:, None, None], slots[:, :, None], slots[:, None]] = g.of_pairs(found)
        return scores

    def _linear(self, name: str, rows: Array) -> Array:
        return self._linears[name](rows)

    def _norm(self, name: str, x: Array) -> Array:
        away = x - x.mean(-1, keepdims=True)
        away /= np.sqrt(np.square(away).mean(-1, keepdims=True) + _EPSILON)
        away *= self._weights[f"{name}.weight"]
        away += self._weights[f"{name}.bias"]
        return away

    def _edges(self, x: Array, pairs: Array, groups: list[_Group]) -> Array:
        """(P, edge) what is known of every ordered pair, the same both ways."""
        near = [pairs[g.rows[:, None, None], g.slots[:, :, None], g.slots[:, None]] for g in groups]
        e = self._linear("pair", np.concatenate([n.reshape(-1, pairs.shape[3]) for n in near]))
        start, end = self._linear("pair_from", x), self._linear("pair_to", x)
        for g in groups:
            of = g.of_pairs(e)
            of += g.halves(start)[:, :, None]
            of += g.halves(end)[:, None]
            np.maximum(of, 0, out=of)
            of[:] = of + of.transpose(0, 2, 1, 3)
        e = self._linear("pair_out", e)
        return np.maximum(e, 0, out=e)

    def _layer(self, name: str, x: Array, e: Array, groups: list[_Group], other: Array) -> Array:
        """Attention inside each junction, then a word with the other end of the branch."""
        heads, (count, width) = self._heads, x.shape
        depth = width // heads
        y = self._linear(f"{name}qkv", self._norm(f"{name}norm", x))
        q, k, v = (part.reshape(count, heads, depth) for part in np.split(y, 3, 1))
        bias = self._linear(f"{name}bias", e)
        heard = np.empty((count, width + heads * e.shape[1]), np.float32)
        for g in groups:
            n, d = g.shape
            near, far, own = (g.halves(part).transpose(0, 2, 1, 3) for part in (q, k, v))
            logits: Array = near @ far.transpose(0, 1, 3, 2)
            logits *= np.float32(depth**-0.5)
            logits += g.of_pairs(bias).transpose(0, 3, 1, 2)
            logits -= logits.max(3, keepdims=True)
            attention = np.exp(logits, out=logits)
            attention /= attention.sum(3, keepdims=True)
            into = g.halves(heard)
            into[..., :width] = (attention @ own).transpose(0, 2, 1, 3).reshape(n, d, width)
            seen = attention.transpose(0, 2, 1, 3) @ g.of_pairs(e)
            into[..., width:] = seen.reshape(n, d, -1)
        x = x + self._linear(f"{name}out", heard)
        y = self._norm(f"{name}norm2", x)
        y = np.concatenate([y, np.concatenate([y, self._weights["alone"]])[other]], 1)
        y = self._linear(f"{name}mix.0", y)
        x += self._linear(f"{name}mix_out", np.maximum(y, 0, out=y))
        return x

    def _scored(self, x: Array, e: Array, groups: list[_Group]) -> Array:
        """(P,) the score of every ordered pair."""
        z, alone = self._linear("head_pair", e), self._linear("head_sum", x)
        product = np.empty_like(z)
        for g in groups:
            of, into, sums = g.of_pairs(z), g.of_pairs(product), g.halves(alone)
            of += sums[:, :, None]
            of += sums[:, None]
            tokens = g.halves(x)
            np.multiply(tokens[:, :, None], tokens[:, None], out=into)
        z += self._linear("head_product", product)
        return self._linear("score", np.maximum(z, 0, out=z))[:, 0]


class _Linear:
    """Rows (N, K) float32 times a matrix (K, M), plus (M,) if there is that; in OpenCV."""

    def __init__(self, weight: Array, bias: Array | None) -> None:
        self._size = weight.shape[1]
        nodes, weights = [Node("MatMul", ["rows", "weight"], ["made"], {})], {"weight": weight}
        if bias is not None:
            nodes.append(Node("Add", ["made", "bias"], ["sum"], {}))
            weights["bias"] = bias
        # The file says that rows are an image; OpenCV takes them as they are.
        content = onnx_file.write(Network(nodes, weights, ["rows"], nodes[-1].outputs))
        self._net = runtimes.RUNTIMES[-1].load(content)

    def __call__(self, rows: Array) -> Array:
        made = np.empty((len(rows), self._size), np.float32)
        for at in range(0, len(rows), _ROWS):
            (made[at : at + _ROWS],) = self._net({"rows": rows[at : at + _ROWS]}, 1)
        return made


def _groups(filled: Array) -> list[_Group]:
    """The junctions by their degree; (J, D) bool: which slots they fill."""
    degree = filled.sum(1)
    found: list[_Group] = []
    at = pairs = 0
    for d in np.unique(degree[degree > 0]).tolist():
        rows = np.flatnonzero(degree == d)
        slots = np.nonzero(filled[rows])[1].reshape(-1, d)
        found.append(_Group(rows, slots, at, pairs))
        at, pairs = at + slots.size, pairs + slots.size * d
    return found
