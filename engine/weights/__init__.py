"""The trained weights beside this file, and what each must contain: digests.json, in SHA-256.

`python -m training.digests` writes the digests anew; the exporters in training/ do it themselves.
"""

from __future__ import annotations

import hashlib
import json
from functools import cache
from pathlib import Path

from ..errors import InvoluteError

FOLDER = Path(__file__).resolve().parent
DIGESTS = "digests.json"
LINEAGE = "lineage.json"  # which runs of training they are from
_NO_WEIGHTS = frozenset({".py", ".md"})


def names(folder: Path = FOLDER) -> list[str]:
    """The files of a folder that hold weights, sorted."""
    return sorted(
        path.name
        for path in folder.iterdir()
        if path.is_file()
        and path.suffix not in _NO_WEIGHTS
        and path.name not in (DIGESTS, LINEAGE)
        and not path.name.startswith(".")
    )


def read(path: Path) -> bytes:
    """The content of a file of weights; what Involute came with is checked, others are taken as is.

    Raises:
        InvoluteError: a file beside this one that is not what its digest says.
        OSError: it can't be read.
    """
    content = path.read_bytes()
    if path.parent == FOLDER and hashlib.sha256(content).hexdigest() != _expected().get(path.name):
        raise InvoluteError(
            f"The weights in {path.name} are damaged; reinstall Involute, or, if you have trained "
            "them yourself, run: python -m training.digests"
        )
    return content


@cache
def _expected() -> dict[str, str]:
    """File name -> digest; of a file that is missing or damaged, nothing."""
    try:
        return dict(json.loads((FOLDER / DIGESTS).read_text("utf-8")))
    except (OSError, ValueError, TypeError):
        return {}
