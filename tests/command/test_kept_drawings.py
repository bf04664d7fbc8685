"""Kept drawings go when they were not used for long, or take up too much."""

from __future__ import annotations

import os
import time
from pathlib import Path

import pytest
from involute.command import kept_drawings


def kept(folder: Path, name: str, days: float, size: int = 100) -> Path:
    """A folder of drawings last used so many days ago."""
    place = kept_drawings.folder_for(folder, Path("/drawings", name))
    (place / ".involute").mkdir(parents=True)
    (place / "000001.json").write_bytes(b" " * size)
    (place / ".involute" / "000001.json.json").write_text("{}")
    then = time.time() - 86400 * days
    os.utime(place, (then, then))
    return place


def test_what_was_not_used_for_long_goes(tmp_path):
    old, recent, used = (kept(tmp_path, n, d) for n, d in (("a", 90), ("b", 30), ("c", 90)))
    own = tmp_path / "notes"
    own.mkdir()
    os.utime(own, (0, 0))
    kept_drawings.tidy(tmp_path, used)
    assert not old.exists()
    assert (recent / "000001.json").exists()
    assert (used / "000001.json").exists()
    assert own.exists()
    kept_drawings.tidy(tmp_path, recent)
    assert used.exists()  # its use was noted


def test_what_takes_up_too_much_goes_longest_unused_first(
    tmp_path, monkeypatch: pytest.MonkeyPatch
):
    monkeypatch.setattr(kept_drawings, "_MOST", 2500)
    places = [kept(tmp_path, str(days), days, 1000) for days in (0.1, 0.2, 0.3, 5, 20)]
    kept_drawings.tidy(tmp_path, places[1])
    assert [place.exists() for place in places] == [True, True, True, False, False]


def test_a_cache_that_is_not_there_is_made(tmp_path):
    used = kept_drawings.folder_for(tmp_path / "none", Path("x"))
    kept_drawings.tidy(tmp_path / "none", used)
    assert used.is_dir()
