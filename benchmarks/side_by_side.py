"""Two results of a benchmark side by side."""

from __future__ import annotations

from .run_record import Record
from .tables import markdown


def table(one: Record, other: Record) -> str:
    """Markdown: what each was taken with, then every figure that both have, and what changed.

    Figures that only one of them has are named below: they can't be compared.
    """
    head = ["", f"{one.run} {one.commit}", f"{other.run} {other.commit}"]
    about = [[key, a, b] for (key, a), (_, b) in zip(_about(one), _about(other), strict=True)]
    ours, theirs = _flat(one), _flat(other)
    rows = [
        [name, f"{ours[name]:g}", f"{theirs[name]:g}", _change(ours[name], theirs[name])]
        for name in ours
        if name in theirs
    ]
    parts = [markdown(head, about), markdown(["figure", *head[1:], "change"], rows)]
    for record, figures, others in ((one, ours, theirs), (other, theirs, ours)):
        if alone := [name for name in figures if name not in others]:
            parts.append(f"Only {record.run} {record.commit}: {'; '.join(alone)}")
    if one.machine != other.machine:
        parts.append("Taken on different machines: seconds can't be compared.")
    return "\n\n".join(parts)


def _about(record: Record) -> list[tuple[str, str]]:
    machine = ", ".join(str(value) for value in record.machine.values())
    return [
        ("when", record.when), ("weights", record.weights), ("machine", machine),
        ("options", " ".join(record.arguments)),
    ]  # fmt: skip


def _flat(record: Record) -> dict[str, float]:
    return {
        f"{row}: {column}": value
        for row, columns in record.figures.items()
        for column, value in columns.items()
    }


def _change(before: float, after: float) -> str:
    if before == after:
        return ""
    share = f" ({100 * (after - before) / before:+.1f} %)" if before else ""
    return f"{after - before:+.3g}{share}"
