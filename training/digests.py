"""Note what the shipped weights contain: `python -m training.digests`, after any of them changed.

The engine checks weights against these digests when it loads them. Weights that no exporter wrote
lose their lineage (`lineage.json`). Standard library only.
"""

from __future__ import annotations

import argparse
import json
from collections.abc import Sequence
from pathlib import Path

from involute.engine import weights

from . import lineage


def main(argv: Sequence[str] | None = None) -> None:
    """The command line."""
    parser = argparse.ArgumentParser(prog="digests", description=__doc__.splitlines()[0])
    parser.parse_args(argv)
    for name, digest in write(weights.FOLDER).items():
        print(digest, name)


def write(folder: Path) -> dict[str, str]:
    """Write the digests of all weights in a folder, and return them by file name."""
    found = {name: lineage.sha256(folder / name) for name in weights.names(folder)}
    lineage.write(folder, lineage.checked(folder))
    (folder / weights.DIGESTS).write_text(json.dumps(found, indent=1) + "\n", "utf-8")
    return found


def note(path: Path, *runs: Path, slimmed_from: Path | None = None) -> None:
    """Bring the digests beside a file of weights up to date, where there are any.

    To be called by whoever writes weights, with the folders of the runs that they are from, or the
    weights of which they are a part.
    """
    if (path.parent / weights.DIGESTS).exists():
        lineage.note_weights(path, *runs, slimmed_from=slimmed_from)
        write(path.parent)


if __name__ == "__main__":
    main()
