"""`involute` and `python -m involute`: the engine's command line, with all that the engine may not
import handed to it: Blender for .blend files, the benchmark's metrics for `evaluate`.
"""

from __future__ import annotations

import sys
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from .engine import Drawing


def main(argv: Sequence[str] | None = None) -> int:
    """Run the command line; see `command.cli.main`."""
    from .command import cli

    return cli.main(
        argv,
        writers={".blend": _write_blend},
        evaluate=_evaluate,
        sequence_writers={".blend": _write_sequence},
    )


def _write_blend(drawings: Sequence[tuple[str, Drawing]], path: Path) -> None:
    from .operators import blend_file

    blend_file.write(drawings, path)


def _write_sequence(name: str, frames: Iterable[tuple[int, Drawing]], path: Path) -> None:
    from .operators import blend_file

    blend_file.write_sequence(name, frames, path)


def _evaluate(prediction: Path, truth: Path) -> Mapping[str, float]:
    from .engine import InvoluteError

    try:
        from .benchmarks import metrics
    except ImportError as error:
        raise InvoluteError(
            f"Evaluating needs a checkout of Involute and its extra 'bench' ({error})."
        ) from error
    try:
        strokes, true_strokes = metrics.read_svg(prediction), metrics.read_svg(truth)
    except OSError as error:
        raise InvoluteError(f"Can't read {error.filename}: {error.strerror}.") from error
    except (ValueError, SyntaxError) as error:
        raise InvoluteError(f"Can't compare them: {str(error).rstrip('.')}.") from error
    return metrics.summarize([metrics.evaluate(strokes, true_strokes)])


if __name__ == "__main__":
    sys.exit(main())
