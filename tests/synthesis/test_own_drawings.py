"""Whoever trains on drawings of their own brings them in as SVG files."""

from __future__ import annotations

import numpy as np
import pytest

pytest.importorskip("shapely")

from involute.engine import vectorize
from involute.synthesis.line_art import Library
from involute.synthesis.own_drawings import main


def test_own_drawings_become_a_set(tmp_path, capsys):
    art = tmp_path / "art"
    (art / "shot 1").mkdir(parents=True)
    page = np.full((120, 160), 255, np.uint8)
    page[58:62, 10:150] = page[20:100, 78:82] = 0
    vectorize(page).save(art / "shot 1" / "reviewed.svg")  # as a traced and reviewed drawing is
    for number in range(30):
        path = f'<path d="M0 {number} L90 50" stroke="#000" fill="none"/>' * 2
        (art / f"walk {number}.svg").write_text(
            f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 100 100">{path}</svg>'
        )
    (art / "photo.svg").write_text("no drawing")
    main([str(art), "--out", str(tmp_path / "data")])
    said = capsys.readouterr().out
    assert "photo.svg: no strokes in it; left out" in said
    assert "own: 31 drawings, 62 strokes" in said
    drawn = Library.load(tmp_path / "data").sets["own"]
    assert "shot 1/reviewed" in drawn.titles
    reviewed = drawn.strokes(drawn.titles.index("shot 1/reviewed"))
    assert len(reviewed) == 2  # one through the other
    assert max(np.ptp(stroke[:, 0]) for stroke in reviewed) == pytest.approx(1024, abs=1)


def test_an_empty_folder_is_told(tmp_path):
    with pytest.raises(SystemExit, match="must hold SVG files"):
        main([str(tmp_path), "--out", str(tmp_path / "data")])
