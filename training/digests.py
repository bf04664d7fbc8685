"""Note what the shipped weights contain: `python -m training.digests`, after any of them changed.

The engine checks weights against these digests when it loads them. Standard library only.
"""

from __future__ import annotations

import argparse
import hashlib
import json
from pathlib import Path

from involute.engine import weights


def main() -> None:
    """The command line."""
    argparse.ArgumentParser(prog="digests", description=__doc__.splitlines()[0]).parse_args()
    for name, digest in write(weights.FOLDER).items():
        print(digest, name)


def write(folder: Path) -> dict[str, str]:
    """Write the digests of all weights in a folder, and return them by file name."""
    found = {name: of(folder / name) for name in weights.names(folder)}
    (folder / weights.DIGESTS).write_text(json.dumps(found, indent=1) + "\n", "utf-8")
    return found


def of(path: Path) -> str:
    """The SHA-256 of a file's content, in hexadecimal digits."""
    return hashlib.sha256(path.read_bytes()).hexdigest()


def note(path: Path) -> None:
    """Bring the digests beside a file of weights up to date, where there are any.

    To be called by whoever writes weights.
    """
    if (path.parent / weights.DIGESTS).exists():
        write(path.parent)


if __name__ == "__main__":
    main()
