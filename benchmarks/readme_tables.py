"""The README's tables, made from the results: `python -m benchmarks tables`.

A table stands between `<!-- benchmark: NAME -->` and `<!-- end -->` and shows the last run of NAME
with its default options.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path

from . import quality, speed
from .run_record import RESULTS, Record, read

README = Path(__file__).resolve().parents[1] / "README.md"
TABLES: dict[str, Callable[[Record], str]] = {
    "quality": quality.readme_table,
    "tangles": quality.readme_table,
    "speed": speed.readme_table,
}
_BLOCK = re.compile(r"(<!-- benchmark: (\w+) -->\n).*?(\n<!-- end -->)", re.DOTALL)


def with_results(text: str, folder: Path = RESULTS) -> str:
    """A README with its tables made anew; a table without a result stays as it is."""

    def table(match: re.Match[str]) -> str:
        before, name, after = match.groups()
        whole = [record for record in read(name, folder) if not record.arguments]
        if not whole:
            return match[0]
        return f"{before}{TABLES[name](whole[-1])}{after}"

    return _BLOCK.sub(table, text)
