"""Training of the centerline network: pages tell the truth, runs resume, exports agree."""

from __future__ import annotations

import json
from multiprocessing import Process
from pathlib import Path

import numpy as np
import pytest

torch = pytest.importorskip("torch")

from involute.engine.centerline import backends, onnx_torch  # noqa: E402
from involute.engine.centerline.backends import load, load_both  # noqa: E402
from involute.engine.centerline.learned import trace_both, trace_maps  # noqa: E402
from involute.engine.centerline.tiles import shift_of  # noqa: E402
from involute.engine.errors import InvoluteError  # noqa: E402
from involute.synthesis import line_art, media, wear  # noqa: E402
from involute.synthesis.line_art import Library  # noqa: E402
from involute.training.centerline import (  # noqa: E402
    losses,
    page_figures,
    shared_pages,
    training_page,
)
from involute.training.centerline.average import main as average  # noqa: E402
from involute.training.centerline.export_centerline import (  # noqa: E402
    export,
    folded,
    keep,
    worst_difference,
)
from involute.training.centerline.page_batches import Pages, split  # noqa: E402
from involute.training.centerline.page_figures import pooled  # noqa: E402
from involute.training.centerline.restore_unet import restored, with_all_heads  # noqa: E402
from involute.training.centerline.targets import targets  # noqa: E402
from involute.training.centerline.train_centerline import main as train  # noqa: E402
from involute.training.centerline.training_page import CHANNELS, page  # noqa: E402
from involute.training.centerline.unet import HEADS, STRIDE, CenterlineNet, Exported  # noqa: E402


@pytest.fixture(scope="session")
def drawings(tmp_path_factory) -> Path:
    """A folder with forty little drawings in the format of the training data."""
    rng = np.random.default_rng(4)
    strokes, per_drawing = [], []
    for _ in range(40):
        made = [line_art._spline(rng, 900) for _ in range(rng.integers(1, 5))]
        strokes += made
        per_drawing.append(len(made))
    folder = tmp_path_factory.mktemp("drawings")
    np.savez(
        folder / "quickdraw_raw.npz",
        points=np.clip(np.concatenate(strokes) * 32, 0, 65535).astype(np.uint16),
        scale=1 / 32,
        stroke_offsets=np.cumsum([0] + [len(s) for s in strokes]),
        drawing_offsets=np.cumsum([0, *per_drawing]),
    )
    return folder


def line(x0: float, y0: float, x1: float, y1: float) -> np.ndarray:
    return np.linspace((x0, y0), (x1, y1), 20).astype(np.float32)


def maps_of(*strokes: np.ndarray, size: int = 96):
    samples = media.sample(list(strokes), size)
    return targets(samples, np.full(len(samples), 2.0), size)


def test_crest_of_the_target_is_the_true_line():
    maps = maps_of(line(5, 40.3, 90, 40.3))
    before, at, after = np.log(maps.centerline[39:42, 50])
    crest = 40.5 + 0.5 * (before - after) / (before + after - 2 * at)
    assert crest == pytest.approx(40.3, abs=0.05)
    assert maps.half_width[40, 50] == pytest.approx(2.0)


def test_crossing_touch_and_free_ends():
    maps = maps_of(
        line(10, 20, 80, 20),  # crossed by the next,
        line(45.5, 5, 45.5, 60),
        line(20.5, 20.5, 20.5, 70),  # touches the first,
        line(45.5, 60, 80, 75),  # a corner with the second
    )
    junctions = page_figures.peaks(maps.junctions, 0.6)
    ends = page_figures.peaks(maps.endpoints, 0.6)
    np.testing.assert_allclose(sorted(map(tuple, junctions)), [(20.5, 20), (45.5, 20)], atol=0.5)
    wanted = [(10, 20), (20, 70), (45, 5), (80, 20), (80, 75)]
    near = [min(np.hypot(*(e - (x, y))) for e in ends) for x, y in wanted]
    assert max(near) < 1.5
    assert len(ends) == len(wanted)


def test_three_ends_meet_in_a_junction_two_do_not():
    three = maps_of(line(48, 48, 10, 10), line(48, 48, 85, 20), line(48, 48, 40, 90))
    assert len(page_figures.peaks(three.junctions, 0.6)) == 1
    two = maps_of(line(48, 48, 10, 10), line(48, 48, 85, 20))
    assert not len(page_figures.peaks(two.junctions, 0.6))
    assert len(page_figures.peaks(two.endpoints, 0.6)) == 2


@pytest.mark.parametrize("gap", [3.0, 4.0, 6.0])
def test_near_lines_keep_a_valley(gap):
    maps = maps_of(line(5, 40, 90, 40), line(5, 40 + gap, 90, 40 + gap))
    across = maps.centerline[36:50, 48]
    crests = (across[1:-1] > across[:-2]) & (across[1:-1] >= across[2:]) & (across[1:-1] > 0.5)
    assert crests.sum() == 2


def test_width_of_the_ink_is_the_pen_s():
    samples = media.sample([line(10, 48, 86, 48)], 96)
    pen = media.Medium(
        (6.0, 6.0), density=(1.0, 1.0), fade=(0, 0), swell=(0, 0), ragged=(0, 0), skip=0
    )
    ink, half = media.draw(np.random.default_rng(1), samples, pen, 6.0, 96)
    assert ink[:, 48].sum() == pytest.approx(6.0, abs=0.1)
    assert half == pytest.approx(3.0)


def test_where_the_pen_skips_the_centerline_goes_on():
    samples = media.sample([line(4, 128, 252, 128)], 256)
    pen = media.Medium((3.0, 3.0), skip=1.0)
    inks = [media.draw(np.random.default_rng(k), samples, pen, 3.0, 256)[0] for k in range(8)]
    paper = np.mean([ink[127:129, 10:246].max(0) < 0.3 for ink in inks])
    assert 0.01 < paper < 0.4
    seen = training_page._visible(samples.position, inks[0])
    maps = targets(samples.take(seen), np.full(np.count_nonzero(seen), 1.5), 256)
    assert maps.centerline[127:129, 10:246].max(0).min() > 0.6


def test_wear_and_dust_darken_a_sheet_here_and_there():
    for seed in range(12):
        left = wear.wear(np.random.default_rng(seed), 128)
        assert left.shape == (128, 128)
        assert left.min() > 0.2
        assert left.max() <= 1.0
        specks = wear.dust(np.random.default_rng(seed), np.zeros((128, 128), np.float32))
        assert 0 <= specks.min() <= specks.max() <= 0.8


def test_a_page_repeats_and_fills_its_channels(drawings):
    library = Library.load(drawings)
    first = page(np.random.default_rng(6), library, 128)
    again = page(np.random.default_rng(6), library, 128)
    assert first.shape == (len(CHANNELS), 128, 128)
    assert first.dtype == np.uint8
    np.testing.assert_array_equal(first, again)


@pytest.mark.parametrize("medium", list(media.MEDIA))
def test_every_medium_draws_where_its_target_says(drawings, medium):
    library = Library.load(drawings)
    pages = [page(np.random.default_rng((k, 3)), library, 160, only=medium) for k in range(6)]
    ink = np.concatenate([p[0].ravel() for p in pages]).astype(float)
    line = np.concatenate([p[1].ravel() for p in pages])
    assert ink[line > 200].mean() > 3 * ink[line == 0].mean()


def test_held_out_drawings_are_never_trained_on(drawings):
    library = Library.load(drawings)
    rng = np.random.default_rng(0)

    def picked(held_out: bool) -> set[bytes]:
        return {library.pick(rng, held_out)[0].tobytes() for _ in range(200)}

    assert not picked(True) & picked(False)


def test_every_loss_prefers_the_truth(drawings):
    batch = next(iter(Pages(drawings, 8, 64, 0.5, 1, keep=16)))
    _, truth = split(batch)
    right = torch.logit(truth.clamp(0.01, 0.99))
    for name in losses.CENTERLINE_LOSSES:
        good = losses.total_loss(right, truth, name)["total"]
        assert good < losses.total_loss(right.roll(3, -1), truth, name)["total"]
        assert good < losses.total_loss(torch.full_like(right, -4), truth, name)["total"]


def test_a_run_stops_resumes_and_is_recorded(drawings, tmp_path):
    options = ["--data", str(drawings), "--run", str(tmp_path), "--workers", "0", "--batch", "1"]
    options += ["--crop", "64", "--widths", "4", "8", "--every", "2"]
    train([*options, "--steps", "4", "--stop-after", "0"])
    halfway = torch.load(tmp_path / "checkpoint.pt")["step"]
    train([*options, "--steps", "4"])
    assert halfway < torch.load(tmp_path / "checkpoint.pt")["step"] == 4
    log = [json.loads(row) for row in (tmp_path / "log.jsonl").read_text().splitlines()]
    assert [row["step"] for row in log] == [2, 4]
    config = json.loads((tmp_path / "config.json").read_text())
    assert config["data_sha256"]
    assert config["seed"] == 1
    assert str(tmp_path) not in json.dumps(config)  # it is shipped with the weights


def _seasoned(net: CenterlineNet) -> CenterlineNet:
    """With norms as a training leaves them, each with its own figures."""
    for layer in net.modules():
        if isinstance(layer, torch.nn.BatchNorm2d):
            layer.running_mean.uniform_(-1, 1)
            layer.running_var.uniform_(0.5, 2)
    return net.eval()


def test_several_runs_learn_from_pages_that_others_draw(drawings, tmp_path, monkeypatch):
    bank = tmp_path / "pages"
    monkeypatch.setattr(shared_pages, "_FEWEST", 3)
    options = ["--data", str(drawings), "--out", str(bank), "--side", "96", "--keep", "4"]
    drawing = Process(target=shared_pages.main, args=(options,))
    drawing.start()
    try:
        batch = next(iter(shared_pages.SharedPages(bank, 5, 64, 96, 1)))
    finally:
        drawing.terminate()
        drawing.join()
    assert batch.shape == (5, len(CHANNELS), 64, 64)
    assert batch.dtype == torch.uint8
    assert batch[:, 1].any()


def test_a_run_goes_on_from_shipped_weights(drawings, tmp_path):
    torch.manual_seed(5)
    net = _seasoned(CenterlineNet((4, 8)))
    export(net, tmp_path / "shipped.onnx")
    again = restored(tmp_path / "shipped.onnx")
    ink = torch.rand(1, 1, 64, 48)
    with torch.inference_mode():
        torch.testing.assert_close(again(ink), folded(net)(ink), atol=1e-5, rtol=0)
    options = ["--data", str(drawings), "--run", str(tmp_path), "--workers", "0", "--batch", "1"]
    options += ["--crop", "64", "--start-from", str(tmp_path / "shipped.onnx")]
    train([*options, "--steps", "2"])
    trained = restored(tmp_path / "checkpoint.pt")
    export(trained, tmp_path / "next.onnx")
    assert worst_difference(trained, tmp_path / "next.onnx") < 1e-3


def test_the_mean_of_two_networks_lies_between_them(tmp_path):
    one, other = (CenterlineNet((4, 8), norms=False).eval() for _ in range(2))
    for net, name in ((one, "one"), (other, "other")):
        export(net, tmp_path / f"{name}.onnx")
    out = tmp_path / "mean.onnx"
    average([str(tmp_path / "one.onnx"), str(tmp_path / "other.onnx"), "--out", str(out)])
    middle = (one.head.weight + other.head.weight) / 2
    torch.testing.assert_close(restored(out).head.weight, middle, atol=1e-3, rtol=0)


def test_opencv_and_both_torch_forms_agree(tmp_path):
    torch.manual_seed(3)
    net = CenterlineNet((4, 8, 12)).eval()
    out = tmp_path / "small.onnx"
    export(net, out)
    assert worst_difference(net, out) < 1e-3
    assert out.stat().st_size < 4 * sum(p.numel() for p in net.parameters())
    ink = np.random.default_rng(0).random((5 * STRIDE, 3 * STRIDE), np.float32)
    with torch.inference_mode():
        given = torch.from_numpy(ink[None, None])
        read, features = onnx_torch.module(out.read_bytes()).all_of(given)
        wanted = Exported(folded(net))(given)
        assert (read - wanted[0]).abs().max() < 1e-5
        assert (features - wanted[1]).abs().max() < 1e-4
    assert features.shape[1:] == (4, 2.5 * STRIDE, 1.5 * STRIDE)
    np.testing.assert_allclose(load(out, "cpu")(ink), read[0].numpy(), atol=1e-3)
    np.testing.assert_allclose(backends._torch(out, "cpu")(ink, 1)[0], read[0].numpy(), atol=1e-3)
    np.testing.assert_allclose(load_both(out, "cpu")(ink)[1], features[0].numpy(), atol=1e-3)


def test_all_maps_and_the_features_reach_the_engine(tmp_path):
    torch.manual_seed(3)
    export(CenterlineNet((4, 8, 12)).eval(), tmp_path / "net.onnx")
    ink = np.zeros((151, 213), np.float32)
    ink[70:73, 20:190] = ink[10:140, 100:104] = 1
    both = load_both(tmp_path / "net.onnx", "cpu")
    maps = trace_both(ink, both, lambda fraction: None)
    assert maps.features.shape == (4, 76, 107)
    for name in ("centerline", "half_width", "solid", "doubled", "apart", "clean", "lifted"):
        assert getattr(maps, name).shape == ink.shape
    plain = trace_maps(ink, load(tmp_path / "net.onnx", "cpu"), lambda fraction: None)
    assert plain.features is None
    near = ink > 0  # farther away the features' maps go on, and the others end
    np.testing.assert_allclose(plain.apart[near], maps.apart[near], atol=1e-5)
    # The page as the network's grid, which is counted from the ink, has it.
    down, right = shift_of(ink)
    sides = [(p, -(n + p) % 64) for n, p in zip(ink.shape, (down, right), strict=True)]
    seen, deep = both(np.pad(ink, sides))
    clean = seen[7, down + 60 : down + 80, right + 90 : right + 110]
    np.testing.assert_allclose(maps.clean[60:80, 90:110], clean, atol=1e-4)
    rows, columns = (slice((n + p) // 2, (n + p) // 2 + 10) for n, p in ((60, down), (90, right)))
    found = maps.features[:, 30:40, 45:55]
    np.testing.assert_allclose(found, deep[:, rows, columns], atol=1e-3)


def test_older_weights_have_five_maps_and_say_that_they_have_no_features():
    from involute.engine.centerline.learned import WEIGHTS

    ink = np.zeros((64, 64), np.float32)
    ink[30:33, 10:50] = 1
    both = load_both(WEIGHTS, "cpu")
    maps = trace_maps(ink, load(WEIGHTS, "cpu"), lambda fraction: None)
    if maps.doubled is None:
        with pytest.raises(InvoluteError, match="no features"):
            trace_both(ink, both, lambda fraction: None)


@pytest.mark.parametrize("counts", [None, (0, 2, 1), (2, 1, 3)])
def test_a_network_of_any_depth_is_read_back(tmp_path, counts):
    torch.manual_seed(2)
    net = _seasoned(CenterlineNet((4, 8, 12), counts))
    export(net, tmp_path / "net.onnx")
    assert worst_difference(net, tmp_path / "net.onnx") < 1e-3
    keep(net, tmp_path / "net.pt")
    ink = torch.rand(1, 1, 3 * STRIDE, 2 * STRIDE)
    for name in ("net.onnx", "net.pt"):
        again = restored(tmp_path / name)
        assert [len(level) for level in again.encode] == list(counts or (1, 2, 2))
        with torch.inference_mode():
            torch.testing.assert_close(again(ink), net(ink), atol=2e-2, rtol=0)


def test_a_network_deeper_than_the_engine_pads_for_is_checked_all_the_same(tmp_path):
    torch.manual_seed(2)
    net = _seasoned(CenterlineNet((4, 4, 4, 4, 4)))
    export(net, tmp_path / "net.onnx")
    assert worst_difference(net, tmp_path / "net.onnx") < 1e-3


def test_weights_to_go_on_from_are_kept_with_their_norms(tmp_path):
    torch.manual_seed(1)
    net = CenterlineNet((4, 8)).eval()
    keep(net, tmp_path / "start.pt")
    ink = torch.rand(1, 1, 32, 48)
    with torch.inference_mode():
        torch.testing.assert_close(
            restored(tmp_path / "start.pt")(ink), net(ink), atol=2e-2, rtol=0
        )
    for name in ("start.pt", "start_rough.pt"):
        start = Path(training_page.__file__).with_name(name)
        state = torch.load(start, "cpu")["mean"]
        assert any("running_mean" in name for name in state)
        assert with_all_heads(restored(start)).head.weight.shape[1] == len(CHANNELS) - 1


def test_training_goes_on_from_weights_with_fewer_heads(drawings, tmp_path):
    torch.manual_seed(5)
    old = _seasoned(CenterlineNet((4, 8)))
    old.head = torch.nn.ConvTranspose2d(4, 5, 4, 2, 1)
    ink, known = torch.rand(1, 1, 32, 48), old.head.out_channels
    export(old, tmp_path / "old.onnx")
    keep(old, tmp_path / "old.pt")
    for file in ("old.onnx", "old.pt"):
        again = restored(tmp_path / file)
        with torch.inference_mode():
            torch.testing.assert_close(again(ink), folded(old)(ink), atol=2e-2, rtol=0)
            more = with_all_heads(again)(ink)
        assert more.shape[1] == len(HEADS)
        with torch.inference_mode():
            torch.testing.assert_close(more[:, :known], folded(old)(ink), atol=2e-2, rtol=0)
        assert more[:, known:].sigmoid().max() < 0.5  # of what it never learned it sees nothing
    options = ["--data", str(drawings), "--run", str(tmp_path), "--workers", "0", "--batch", "1"]
    train([*options, "--crop", "64", "--steps", "2", "--start-from", str(tmp_path / "old.onnx")])
    assert restored(tmp_path / "checkpoint.pt").head.out_channels == len(HEADS)
    # What the engine is not told it does not claim to see.
    maps = trace_maps(np.zeros((64, 64), np.float32), load(tmp_path / "old.onnx", "cpu"), print)
    assert maps.solid is not None
    assert maps.clean is maps.lifted is None


def test_lines_that_end_are_told_from_lines_that_go_on():
    truth = np.zeros((len(HEADS), 64, 64), np.float32)
    truth[[0, 7], 32, 4:60] = truth[[0, 7], 4:60, 20] = 1
    truth[8, 32, 20:26] = [1, 0.9, 0.8, 0.7, 0.6, 0.5]
    truth[1, 32, 20] = 1
    figures = pooled([page_figures.page_figures(truth, truth)] * 2)
    assert figures["lifted_auc"] == figures["lifted_near_auc"] == 1
    blind = truth.copy()
    blind[8] = 0.3
    assert pooled([page_figures.page_figures(blind, truth)])["lifted_auc"] == 0.5
    older = page_figures.page_figures(truth[:8], truth)
    assert "lifted_auc" not in pooled([older])
