"""Stages kept: a page asked again with other settings runs only what these change."""

from __future__ import annotations

from dataclasses import fields, replace
from pathlib import Path

import cv2
import numpy as np
import pytest
from involute.engine import Cancelled, KeptStages, Settings, pipeline, vectorize
from involute.engine.drawing import Drawing
from involute.engine.settings import ABOUT, STAGE_OF, STAGES

SIDE = 160
RUN = (*STAGES, "check")
# Another value than the default for every setting.
OTHER = {
    name: (about.values[1:2] if about.kind is tuple else about.values[-1])
    if about.choices
    else {"pen_width": 4.0, "solid_width": 9.0}.get(name)
    for name, about in ABOUT.items()
}
OTHER |= {name: not Settings.__dataclass_fields__[name].default
          for name, about in ABOUT.items() if about.kind is bool}  # fmt: skip
OTHER |= {"min_length": 6.0, "smoothing": 0.8, "corners": 0.5, "width_scale": 2.0, "tolerance": 1.0}
OTHER |= {"polarity": "dark", "small_parts": 12.0, "provider": "classical", "device": "cpu"}
OTHER |= {"align": ((20.0, 20.0), (120.0, 20.0))}


def page() -> np.ndarray:
    """(SIDE, SIDE, 3) uint8: a cross, a blue line, a dot and a black area."""
    picture = np.full((SIDE, SIDE, 3), 255, np.uint8)
    for a, b, color in (((15, 20), (140, 90), (0, 0, 0)), ((20, 95), (130, 15), (0, 0, 0)),
                        ((15, 110), (140, 120), (40, 80, 220))):  # fmt: skip
        cv2.line(picture, a, b, color, 3, cv2.LINE_AA)
    cv2.circle(picture, (120, 140), 14, (0, 0, 0), -1, cv2.LINE_AA)
    cv2.circle(picture, (40, 140), 2, (0, 0, 0), -1, cv2.LINE_AA)
    return picture


@pytest.fixture(scope="module")
def traced() -> KeptStages:
    """The stages of `page`, traced with the defaults."""
    kept = KeptStages()
    vectorize(page(), kept=kept)
    return kept


def looks(drawing: Drawing) -> list[bytes]:
    """All that is drawn, as bytes."""
    drawn = [a.tobytes() for s in drawing.strokes for a in (s.points, s.widths, s.opacity)]
    return drawn + [ring.tobytes() for fill in drawing.fills for ring in fill]


def test_every_setting_names_the_stage_that_it_touches() -> None:
    assert set(STAGE_OF) == {field.name for field in fields(Settings)} == set(OTHER)
    assert set(STAGE_OF.values()) <= set(STAGES)


@pytest.mark.parametrize("name", OTHER)
def test_a_change_runs_its_stage_and_those_after_it_and_draws_as_ever(
    name: str, traced: KeptStages
) -> None:
    settings = replace(Settings(), **{name: OTHER[name]})
    assert settings != Settings()
    again = vectorize(page(), settings, kept=traced)
    first = RUN.index(STAGE_OF[name])
    if OTHER[name] != "given":
        assert tuple(again.seconds) == RUN[first:]
    anew = vectorize(page(), settings)
    assert tuple(anew.seconds) == RUN
    assert looks(again) == looks(anew)
    assert again.settings == settings


class _Watched(Settings):
    """Settings that note who reads them: (stage, setting)."""

    def __getattribute__(self, name: str) -> object:
        if name in STAGE_OF and (stage := _Watched.stage):
            _Watched.read.add((stage, name))
        return super().__getattribute__(name)

    read: set[tuple[str, str]] = set()
    stage = ""


def test_no_stage_reads_a_setting_that_a_later_one_declares(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    class Clock(pipeline._Clock):
        def __enter__(self):
            _Watched.stage = self._stage
            return super().__enter__()

        def __exit__(self, *error: object) -> None:
            super().__exit__(*error)
            _Watched.stage = ""

    monkeypatch.setattr(pipeline, "_Clock", Clock)
    for chosen in ({}, {"curve": "bezier", "regions": True, "corners": 0.0, "solid_width": 9.0}):
        vectorize(page(), _Watched(**chosen))
    early = {
        (stage, name)
        for stage, name in _Watched.read
        if RUN.index(stage) < RUN.index(STAGE_OF[name])
    }
    # Whether the picture already is a centerline is asked from the first stage on; see `keys`.
    assert {name for _, name in early} <= {"provider"}
    assert {name for _, name in _Watched.read} > {"polarity", "tolerance", "min_length", "router"}


def test_the_same_again_runs_nothing(traced: KeptStages) -> None:
    again = vectorize(page(), kept=traced)
    assert not again.seconds
    assert looks(again) == looks(vectorize(page()))


def test_another_picture_runs_all_of_it(traced: KeptStages) -> None:
    other = page()
    other[:8, :8] = 0
    assert tuple(vectorize(other, kept=traced).seconds) == RUN


def test_a_file_that_changes_is_another_picture(tmp_path: Path) -> None:
    kept, file = KeptStages(), tmp_path / "page.png"
    cv2.imwrite(str(file), page())
    first = vectorize(file, kept=kept)
    assert looks(vectorize(file, kept=kept)) == looks(first)
    cv2.imwrite(str(file), page()[::-1])
    assert tuple(vectorize(file, kept=kept).seconds) == RUN


def test_what_was_made_before_it_was_cancelled_is_kept() -> None:
    def stop(stage: str, fraction: float) -> None:
        if stage == "graph":
            raise Cancelled

    kept = KeptStages()
    with pytest.raises(Cancelled):
        vectorize(page(), progress=stop, kept=kept)
    assert tuple(vectorize(page(), kept=kept).seconds) == RUN[RUN.index("graph") :]


def test_no_more_is_kept_than_may_be() -> None:
    kept = KeptStages(most=200e3)
    expected = looks(vectorize(page()))
    for _ in range(2):
        assert looks(vectorize(page(), kept=kept)) == expected
    assert 0 < kept._size <= 200e3
    kept.clear()
    assert tuple(vectorize(page(), kept=kept).seconds) == RUN


def test_progress_never_goes_back(traced: KeptStages) -> None:
    told: list[float] = []
    vectorize(page(), Settings(min_length=2.5), lambda _, done: told.append(done), kept=traced)
    assert told == sorted(told)
    assert told[-1] <= 1
