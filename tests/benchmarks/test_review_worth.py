"""What a review is worth, on a page small enough to count by hand."""

from __future__ import annotations

from pathlib import Path

import cv2
import numpy as np
import pytest
from involute.engine import Settings, vectorize
from involute.training.routing.labels import labelled

from benchmarks.judged_pages import JudgedPage
from benchmarks.review_worth import Reviewed, reviewed, wrong_lengths

BAR, POST = np.array([(100.0, 500.0), (900, 500)]), np.array([(400.0, 100.0), (400, 900)])
_SVG = (
    '<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 1024 1024" fill="none" stroke="black">'
    '<path d="M100 500L900 500"/><path d="M400 100L400 900"/></svg>'
)


@pytest.fixture
def page(tmp_path: Path) -> JudgedPage:
    image = np.full((1024, 1024), 255, np.uint8)
    for line in (BAR, POST):
        cv2.polylines(image, [line.astype(np.int32)], False, 0, 4, cv2.LINE_AA)
    cv2.imwrite(str(tmp_path / "cross.png"), image)
    (tmp_path / "cross.svg").write_text(_SVG, "utf-8")
    return JudgedPage("cross", tmp_path / "cross.png", tmp_path / "cross.svg", "pen", "white")


def test_what_a_wrong_answer_leads_wrong(page):
    drawing = vectorize(page.image, Settings(provider="classical", router="geometric"))
    true = labelled(drawing.graph, [BAR, POST]).partner
    assert wrong_lengths(drawing, true).tolist() == [0.0]
    (junction,) = drawing.junctions
    (other, *_) = (way.pairs for way in junction.alternatives if way.pairs != junction.pairs)
    turned = drawing.reroute(0, other)
    (wrong,) = wrong_lengths(turned, true)
    assert 0 < wrong < 1600
    ended = drawing.reroute(0, ())  # four lines of 300, 500, 400 and 400 px
    assert wrong_lengths(ended, true)[0] == pytest.approx(1100, abs=12)


def test_what_is_right_is_right(page):
    figures = Reviewed.joined([reviewed(page)]).figures()
    assert figures["junctions"] == figures["right"] == 1.0
    assert figures["found by cost"] == 0.0  # nothing is wrong
