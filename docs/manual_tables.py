"""Writes the tables of the manual that follow from the code: `python docs/manual_tables.py`."""

from __future__ import annotations

import re
from pathlib import Path

from involute.command.setting_options import manual_tables
from involute.engine.formats import FORMATS
from involute.engine.formats.picture_kinds import KINDS, Kind
from involute.operators.blend_file import BLEND

MANUAL = Path(__file__).resolve().parent / "manual"
_PLACE = re.compile(r"(<!-- table (\w+) -->\n).*?(\n<!-- end -->)", re.DOTALL)


def formats() -> str:
    """What drawings can be written to."""
    rows = [f"| `{f.suffix}` | {f.about} |" for f in (*FORMATS, BLEND)]
    return "\n".join(["| file | what it is |", "|---|---|", *rows])


def pictures() -> str:
    """What pictures are read, and what to do with the others."""
    rows = [
        f"| {kind.name} | {' '.join(f'`{suffix}`' for suffix in kind.suffixes)} | {_read(kind)} |"
        for kind in KINDS
    ]
    return "\n".join(["| picture | files | |", "|---|---|---|", *rows])


def _read(kind: Kind) -> str:
    if kind.needs:
        return f"{kind.about}, with the extra `pictures`; without it: {kind.remedy}"
    return f"not read: {kind.remedy}" if kind.remedy else kind.about or "read"


TABLES = {"pictures": pictures, "settings": manual_tables, "formats": formats}


def with_tables(text: str) -> str:
    """A page of the manual with its tables as they are now."""
    return _PLACE.sub(lambda place: place[1] + TABLES[place[2]]() + place[3], text)


if __name__ == "__main__":
    for page in MANUAL.glob("*.md"):
        page.write_text(with_tables(page.read_text("utf-8")), "utf-8")
