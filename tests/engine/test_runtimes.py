"""What runs the networks: every runtime that is here draws the same."""

from __future__ import annotations

from pathlib import Path

import cv2
import numpy as np
import pytest
from involute.command import receipts
from involute.engine import InvoluteError, Settings, runtimes, vectorize, weights
from involute.engine.centerline import backends, learned

EXAMPLE = Path(__file__).resolve().parents[2] / "examples" / "hippopotamus.jpg"
NEAR = 0.05  # px, that a stroke of one runtime may stray from that of another


@pytest.fixture
def use(monkeypatch: pytest.MonkeyPatch):
    """A function that asks for a runtime by its name; skips where that isn't installed."""

    def ask(name: str) -> None:
        if name not in [runtime.name for runtime in runtimes.here()]:
            pytest.skip(f"{name} is not installed; tests/run.py fast installs it")
        monkeypatch.setenv(runtimes.VARIABLE, name)

    return ask


def test_opencv_is_always_here_and_the_last_choice(monkeypatch: pytest.MonkeyPatch) -> None:
    assert runtimes.here()[-1].name == "opencv"
    monkeypatch.delenv(runtimes.VARIABLE, raising=False)
    assert runtimes.chosen() is runtimes.here()[0]


def test_a_runtime_that_is_not_here_is_said_in_a_sentence(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(runtimes.VARIABLE, "abacus")
    with pytest.raises(InvoluteError, match=r"INVOLUTE_RUNTIME is 'abacus'.*opencv"):
        runtimes.chosen()


@pytest.mark.parametrize("runtime", runtimes.RUNTIMES, ids=lambda r: r.name)
def test_what_is_no_network_is_refused(runtime: runtimes.Runtime, use) -> None:
    use(runtime.name)
    with pytest.raises(ValueError, match=r"."):
        runtime.load(b"no network")


@pytest.mark.parametrize("name", [r.name for r in runtimes.RUNTIMES[:-1]])
def test_maps_are_the_same_in_every_runtime(name: str, use) -> None:
    page = cv2.imread(str(EXAMPLE), cv2.IMREAD_GRAYSCALE)[:160, :192]
    inputs = {backends.INPUT: np.ascontiguousarray(1 - page[None, None].astype(np.float32) / 255)}
    content = weights.read(learned.WEIGHTS)
    use(name)
    seen = runtimes.load(content)(inputs, 1)[0]
    use("opencv")
    np.testing.assert_allclose(seen, runtimes.load(content)(inputs, 1)[0], atol=runtimes.SAME)


@pytest.mark.parametrize("name", [r.name for r in runtimes.RUNTIMES[:-1]])
def test_drawings_are_the_same_in_every_runtime(name: str, use) -> None:
    page = cv2.imread(str(EXAMPLE))[:400, :500, ::-1]
    use(name)
    found = vectorize(page)
    use("opencv")
    expected = vectorize(page)
    assert len(found.junctions) == len(expected.junctions)
    np.testing.assert_array_equal(found.routing.partner, expected.routing.partner)
    for one, other in zip(found.strokes, expected.strokes, strict=True):
        line = other.points.reshape(-1, 1, 2)
        away = [abs(cv2.pointPolygonTest(line, p, True)) for p in one.points.tolist()]
        assert max(away) < NEAR


def test_receipts_know_the_runtime(use, tmp_path: Path) -> None:
    image = tmp_path / "page.png"
    cv2.imwrite(str(image), np.full((32, 32), 255, np.uint8))
    keys = set()
    for runtime in runtimes.RUNTIMES:
        receipts.program.cache_clear()
        use(runtime.name)
        keys.add(receipts.fingerprint(str(image), 0, Settings()))
    receipts.program.cache_clear()
    assert len(keys) == len(runtimes.RUNTIMES)
