"""docs/guarantees.md names tests that there are."""

from __future__ import annotations

import re
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]


def test_every_promise_names_its_tests():
    text = (ROOT / "docs" / "guarantees.md").read_text("utf-8")
    names = re.findall(r"`((?:command|engine|blender)/test_\w+\.py)`((?:[:,] `test_\w+`)*)", text)
    assert len(names) > 12
    for file, functions in names:
        source = (ROOT / "tests" / file).read_text("utf-8")
        for function in re.findall(r"test_\w+", functions):
            assert f"def {function}(" in source, f"{file} has no {function}"
