"""Learning to route: pages, what is done to them, how right is counted, and what is shipped."""

from __future__ import annotations

from argparse import Namespace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

pytest.importorskip("torch", reason="training needs torch")
pytest.importorskip("scipy", reason="training needs SciPy")

import torch
from involute.engine.involution import pair_matrix
from involute.engine.routing import network
from involute.engine.routing.encoding import PAIR_SIZE, TOKEN_SIZE
from involute.engine.settings import Settings
from involute.synthesis.composed_pages import Library, net
from involute.synthesis.true_graph import graph_from_strokes
from involute.training.routing.augment import Page, _tips, augmented, contracted, random_fixed
from involute.training.routing.export_routing import calibrate, export, load
from involute.training.routing.graph_bank import Bank, encoded, halved, joined, true_page
from involute.training.routing.hand_drawn import hand_drawn, in_window
from involute.training.routing.judge import judge
from involute.training.routing.labels import labelled, unowned
from involute.training.routing.likelihood import exact, sinkhorn
from involute.training.routing.page_file import load as load_pages
from involute.training.routing.page_file import save
from involute.training.routing.restore_transformer import restored
from involute.training.routing.set_transformer import RoutingNet
from involute.training.routing.supply import Supply, on_device, together
from involute.training.routing.traced import graph_of, look_ideal, look_ink, look_scan
from involute.training.routing.train_routing import run, train
from involute.training.routing.widen import widened

seeds = st.integers(0, 2**32 - 1)


def _line(*points: tuple[float, float]) -> np.ndarray:
    corners = np.array(points, float)
    t = np.linspace(0, len(points) - 1, 30 * (len(points) - 1) + 1)
    return np.stack([np.interp(t, np.arange(len(points)), corners[:, c]) for c in (0, 1)], 1)


CROSS = [_line((20, 60), (180, 70)), _line((90, 10), (100, 150)), _line((140, 68), (150, 150))]


@pytest.fixture(scope="module")
def drawings(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder like the training data: one source with a few nets as drawings."""
    folder = tmp_path_factory.mktemp("drawings")
    rng = np.random.default_rng(0)
    pages = [net(rng) for _ in range(30)]
    lines = [line / 500 * 1024 for page in pages for line in page]
    np.savez(
        folder / "openclipart.npz",
        points=np.concatenate(lines).clip(0, 2000).astype(np.uint16),
        stroke_offsets=np.cumsum([0] + [len(line) for line in lines]),
        drawing_offsets=np.cumsum([0] + [len(page) for page in pages]),
        scale=np.float32(1.0),
    )
    return folder


def _scores(rng: np.random.Generator, degrees: list[int]) -> tuple[np.ndarray, ...]:
    """Random symmetric scores, mask and a random true involution of junctions."""
    slots = max(degrees)
    scores = rng.normal(0, 2, (len(degrees), slots, slots)).astype(np.float32)
    scores += scores.transpose(0, 2, 1)
    mask = (np.arange(slots) < np.array(degrees)[:, None]).astype(np.float32)
    truth = np.zeros_like(scores)
    for row, degree in enumerate(degrees):
        a, b = np.triu_indices(degree, 1)
        ways = pair_matrix(degree)
        truth[row, a, b] = truth[row, b, a] = ways[rng.integers(len(ways))]
    return scores, mask, truth


@given(seeds)
@settings(max_examples=20, deadline=None)
def test_the_exact_loss_is_the_probability_of_the_truth(seed: int) -> None:
    scores, mask, truth = _scores(np.random.default_rng(seed), [3, 4, 6])
    loss = exact(*(torch.from_numpy(a) for a in (scores, mask, truth))).numpy()
    verdict = judge(scores, mask, truth)
    np.testing.assert_allclose(loss, verdict.loss, atol=1e-4)
    chosen = verdict.correct
    np.testing.assert_allclose(np.exp(-loss[chosen]), verdict.probability[chosen], atol=1e-5)


def test_contradicting_pairs_count_as_either() -> None:
    scores, mask, truth = _scores(np.random.default_rng(1), [3])
    truth[:] = 0
    truth[0, 0, 1] = truth[0, 1, 0] = truth[0, 0, 2] = truth[0, 2, 0] = 1
    loss = exact(*(torch.from_numpy(a) for a in (scores, mask, truth)))
    weight = np.exp([0, scores[0, 0, 1], scores[0, 0, 2], scores[0, 1, 2]])
    assert float(loss[0]) == pytest.approx(-np.log(weight[1:3].sum() / weight.sum()), abs=1e-4)


def test_the_papers_loss_prefers_the_truth() -> None:
    _, mask, truth = _scores(np.random.default_rng(2), [3, 4, 5])
    torch.manual_seed(0)
    arrays = torch.from_numpy(mask), torch.from_numpy(truth)
    right = sinkhorn(torch.from_numpy(truth * 20 - 10), *arrays)
    wrong = sinkhorn(torch.from_numpy(10 - truth * 20), *arrays)
    assert torch.isfinite(right).all()
    assert (right < wrong).all()


@given(seeds)
@settings(max_examples=15, deadline=None)
def test_what_is_done_to_a_page_keeps_its_truth_an_involution(seed: int) -> None:
    rng = np.random.default_rng(seed)
    page = augmented(rng, true_page(net(rng)))
    graph, partner = page.graph, page.partner
    np.testing.assert_array_equal(partner[partner], np.arange(len(partner)))
    np.testing.assert_array_equal(graph.half_vertex[partner], graph.half_vertex)
    first, last = graph.points[graph.offsets[:-1]], graph.points[graph.offsets[1:] - 1]
    np.testing.assert_allclose(first, graph.vertices[graph.ends[:, 0]], atol=1e-2)
    np.testing.assert_allclose(last, graph.vertices[graph.ends[:, 1]], atol=1e-2)
    for junction, pairs in random_fixed(rng, page, 0.5).items():
        assert {h for pair in pairs for h in pair} <= set(
            graph.halves_of(int(graph.junctions[junction])).tolist()
        )


def test_contracting_a_short_branch_joins_what_ran_through_it() -> None:
    stem, other = _line((99, 60), (70, 150)), _line((102, 60), (130, -30))
    page = true_page([_line((20, 60), (180, 60)), stem, other])
    assert len(page.graph.junctions) == 2
    page = contracted(page, 6.0)
    assert len(page.graph.junctions) == 1
    assert page.graph.branch_count == 4
    joined_pairs = [(h, int(p)) for h, p in enumerate(page.partner) if h < p]
    assert len(joined_pairs) == 1
    directions = [
        page.graph.half_branch(h)[-1] - page.graph.half_branch(h)[0] for h in joined_pairs[0]
    ]
    assert directions[0] @ directions[1] < 0


def _traced(strokes: list[np.ndarray]) -> Page:
    maps, scan = look_ideal(np.random.default_rng(0), strokes, Settings())
    return labelled(graph_of(maps, scan, Settings()), strokes)


def _continuations(page: Page) -> int:
    """Pairs of half-branches that continue each other at junctions."""
    own = np.arange(len(page.partner))
    at = page.graph.degrees[page.graph.half_vertex] >= 3
    return int((at & (page.partner > own)).sum())


def test_a_traced_page_is_matched_to_its_strokes(tmp_path: Path) -> None:
    page = _traced(CROSS)
    degrees = sorted(page.graph.degrees[page.graph.junctions].tolist())
    assert degrees == [3, 4]
    assert _continuations(page) == 3


def test_a_file_of_pages_keeps_what_routing_sees(tmp_path: Path) -> None:
    ideal = _traced(CROSS)
    maps, scan = look_ink(np.random.default_rng(3), CROSS, Settings(provider="classical"))
    inked = labelled(graph_of(maps, scan, Settings()), CROSS)
    pages = [ideal, inked, ideal]
    save(tmp_path / "pages.npz", pages)
    again = load_pages(tmp_path / "pages.npz")
    assert len(again) == 3
    for page, read in zip(pages, again, strict=True):
        np.testing.assert_array_equal(read.partner, page.partner)
        np.testing.assert_array_equal(read.graph.ends, page.graph.ends)
        np.testing.assert_array_equal(
            read.stroke[read.graph.offsets[:-1]], page.stroke[page.graph.offsets[:-1]]
        )
        before, after = encoded(page, {}, 4), encoded(read, {}, 4)
        np.testing.assert_allclose(after.tokens, before.tokens, atol=0.15)
        assert np.abs(after.tokens - before.tokens).mean() < 0.01
        assert np.abs(after.pairs - before.pairs).mean() < 0.01
    assert again[0].graph.widths is None
    assert again[1].graph.widths is not None


@given(seeds)
@settings(max_examples=20, deadline=None)
def test_a_window_holds_the_pieces_of_strokes_that_are_in_it(seed: int) -> None:
    rng = np.random.default_rng(seed)
    line = _line((0, 0), (1000, 0), (1000, 1000))
    pieces = in_window(rng, [line], 300.0)
    size = np.max([piece.max(0) for piece in pieces], 0)
    assert (size <= 300 + 12 + 1e-6).all()
    length = sum(np.hypot(*np.diff(piece, axis=0).T).sum() for piece in pieces)
    assert 150 <= length <= 602


def test_a_hand_draws_within_its_window(drawings: Path) -> None:
    library = Library.load(drawings, held_out=False)
    rng = np.random.default_rng(1)
    for _ in range(8):
        strokes = hand_drawn(rng, library)
        assert strokes
        assert min(line.min() for line in strokes) >= 11.99
        assert max(line.max() for line in strokes) <= 660


def test_a_scanned_page_is_matched_to_its_strokes() -> None:
    maps, scan = look_scan(np.random.default_rng(3), CROSS, Settings(provider="classical"))
    strokes = [line / scan.scale for line in CROSS]
    page = labelled(graph_of(maps, scan, Settings()), strokes)
    assert unowned(page) < 0.1
    assert _continuations(page) >= 2
    assert page.graph.widths is not None


def test_a_branch_of_two_strokes_has_one_owner_at_both_ends() -> None:
    """Two strokes that run together for a while: the tracer makes one branch of both there."""
    straight = _line((20, 60), (100, 60), (160, 60), (240, 60))
    other = _line((20, 20), (100, 61.3), (160, 61.3), (240, 100))
    page = _traced([straight, other])
    graph = page.graph
    shared = [b for b in range(graph.branch_count) if 100 < graph.branch(b)[:, 0].mean() < 160]
    assert len(shared) == 1
    beyond = page.partner[[2 * shared[0], 2 * shared[0] + 1]]
    assert len(set(page.stroke[graph.offsets[beyond >> 1]])) == 1
    assert _continuations(page) == 2


def test_strokes_run_past_what_nobody_drew() -> None:
    """A rung between two hatch lines and a spur continue in nothing."""
    rails = [_line((20, 60), (180, 60)), _line((20, 65), (180, 65))]
    rung, spur = _line((100, 60), (100, 65)), _line((140, 60), (140, 48))
    graph, _ = graph_from_strokes([*rails, rung, spur])
    assert len(graph.junctions) == 3
    page = labelled(graph, rails)
    assert _continuations(page) == 3
    false = np.flatnonzero(page.stroke[graph.offsets[:-1]] < 0)
    assert len(false) == 2
    halves = np.concatenate([2 * false, 2 * false + 1])
    np.testing.assert_array_equal(page.partner[halves], halves)
    assert unowned(page) == pytest.approx(17 / 337, abs=0.01)


def test_batches_that_are_kept_are_taken_together() -> None:
    torch.manual_seed(5)
    model = RoutingNet(width=16, edge=8, layers=2).eval()
    parts = [encoded(true_page(net(np.random.default_rng(k))), {}, 6) for k in range(3)]
    on_cpu = [on_device(halved(part), "cpu") for part in parts]
    scores = run(model, together(on_cpu), "cpu")
    apart = torch.cat([run(model, part, "cpu") for part in on_cpu])
    torch.testing.assert_close(scores, apart, atol=1e-5, rtol=1e-4)
    for kept in (0, 2):
        supply = iter(Supply(iter(parts), "cpu", together=2, kept=kept))
        assert next(supply).mask.shape[1] == 6


def test_strokes_taper_only_where_they_end() -> None:
    page = true_page(CROSS)
    tip, _ = _tips(np.random.default_rng(0), page)
    graph = page.graph
    ends = np.stack([graph.offsets[:-1], graph.offsets[1:] - 1], 1).reshape(-1)
    through = page.partner != np.arange(len(page.partner))
    assert tip[ends[through]].max() < 0.2
    assert tip[ends[~through]].max() == 1


def test_shipped_weights_can_be_trained_on(tmp_path: Path) -> None:
    torch.manual_seed(3)
    model = RoutingNet(width=16, edge=8, layers=2).eval()
    for weight in model.parameters():
        torch.nn.init.normal_(weight)
    export(model, tmp_path / "routing.onnx")
    for name, weight in restored(tmp_path / "routing.onnx").state_dict().items():
        torch.testing.assert_close(weight, model.state_dict()[name], atol=0, rtol=0)


def test_a_wider_network_starts_with_the_same_scores() -> None:
    torch.manual_seed(4)
    model = RoutingNet(width=16, edge=8, layers=2).eval()
    for weight in model.parameters():
        torch.nn.init.normal_(weight, std=0.3)
    wide = widened(model).eval()
    assert wide.config["width"] == 32
    batch = encoded(true_page(net(np.random.default_rng(4))), {}, 8)
    scores, again = run(model, batch, "cpu"), run(wide, batch, "cpu")
    torch.testing.assert_close(again, scores, atol=2e-3, rtol=1e-3)


def test_batches_join_pages_without_mixing_them() -> None:
    pages = [true_page(CROSS), true_page(net(np.random.default_rng(4)))]
    parts = [encoded(page, {}, 8) for page in pages]
    model = RoutingNet(width=16, edge=8, layers=2)
    together = run(model, joined(parts), "cpu")
    apart = torch.cat([run(model, part, "cpu") for part in parts])
    mask = torch.from_numpy(joined(parts).mask)
    both = mask[:, :, None] * mask[:, None, :]
    torch.testing.assert_close(together * both, apart * both, atol=1e-5, rtol=1e-4)


def test_what_the_engine_runs_is_what_was_trained(drawings: Path, tmp_path: Path) -> None:
    arguments = Namespace(
        data=drawings, out=tmp_path, steps=3, junctions=40, rate=1e-3, loss="exact", width=64,
        every=2, pages=3, minutes=10.0, seed=1, device="cpu", traced=[], traced_held_out=None,
        traced_share=0.0, start=None, dropout=0.1, workers=0, together=1, kept=0,
    )  # fmt: skip
    train(arguments)
    arguments.steps = 4
    train(arguments)  # goes on from its checkpoint
    assert len((tmp_path / "log.jsonl").read_text().splitlines()) == 3

    model = load(tmp_path / "checkpoint.pt")
    batch = Bank(Library.load(drawings, held_out=False), seed=3).batch(30, 8)
    calibration = calibrate(model, [batch])
    export(model, tmp_path / "routing.onnx")
    (tmp_path / "routing.json").write_text(str(calibration).replace("'", '"'))
    shipped, read = network.load(tmp_path)
    assert read == calibration
    for junctions, slots in ((1, 3), (17, 5), (40, 8)):
        rng = np.random.default_rng(junctions)
        arrays = {
            "tokens": rng.normal(0, 1, (junctions, slots, TOKEN_SIZE)).astype(np.float32),
            "pairs": rng.normal(0, 1, (junctions, slots, slots, PAIR_SIZE)).astype(np.float32),
            "mask": (rng.random((junctions, slots)) < 0.8).astype(np.float32),
        }
        ends = np.append(np.flatnonzero(arrays["mask"]), junctions * slots)
        sibling = rng.choice(ends, (junctions, slots))
        with torch.no_grad():
            expected = model(
                torch.from_numpy(arrays["tokens"]),
                torch.from_numpy(arrays["pairs"]),
                torch.from_numpy(sibling.ravel()),
                torch.from_numpy(arrays["mask"]),
            ).numpy()
        filled = arrays["mask"] > 0
        there = filled[:, :, None] & filled[:, None]
        found = shipped(**arrays, sibling=sibling)
        np.testing.assert_allclose(found[there], expected[there], atol=1e-4)
