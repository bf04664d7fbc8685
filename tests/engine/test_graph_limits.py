"""Every limit of the graph stage has a unit, a reason and its evidence."""

from __future__ import annotations

import ast
from pathlib import Path

import pytest
from involute.engine.graph import limits

ROOT = Path(limits.__file__).parents[2]
UNITS = {
    "px", "1/px²", "ridge widths", "pen widths", "points", "share", "times", "cosine", "degrees",
    "cost", "probability", "percentile",
}  # fmt: skip


@pytest.mark.parametrize("row", limits.table(), ids=lambda row: row.name)
def test_every_limit_says_why(row: limits.Row) -> None:
    assert row.unit in UNITS
    assert len(row.why) > 10
    assert row.source


def test_the_document_has_every_measured_limit_with_its_value() -> None:
    said = (ROOT / "docs" / "graph-limits.md").read_text("utf-8")
    said = " ".join(said.split())
    measured = [row for row in limits.table() if row.source == limits.MEASURED]
    assert len(measured) > 50
    missing = [r.name for r in measured if f"| {r.name} | {r.value:g} {r.unit} |" not in said]
    assert not missing, "run `python -m benchmarks.graph_limits`"


def test_other_constants_say_what_they_are() -> None:
    """A number on its own line in a module has a comment beside it."""
    silent = []
    for path in sorted((ROOT / "engine" / "graph").rglob("*.py")):
        lines = path.read_text("utf-8").splitlines()
        for node in ast.parse("\n".join(lines)).body:
            value = getattr(getattr(node, "value", None), "value", None)
            number = isinstance(node, ast.Assign) and isinstance(value, int | float)
            if number and "#" not in lines[node.lineno - 1]:
                silent.append(f"{path.name}: {lines[node.lineno - 1]}")
    assert not silent


def test_a_changed_limit_comes_back() -> None:
    before = limits.LIMITS.gap_least
    with limits.changed(gap_least=9.0):
        assert limits.LIMITS.gap_least == 9.0
    assert limits.LIMITS.gap_least == before
