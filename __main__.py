"""`involute` and `python -m involute`: the engine's command line, with all that the engine may not
import handed to it: Blender for .blend files, the benchmark's metrics for `evaluate`.
"""

from __future__ import annotations

import sys
from collections.abc import Mapping, Sequence
from pathlib import Path


def main(argv: Sequence[str] | None = None) -> int:
    """Run the command line; see `command.cli.main`."""
    from .command import cli
    from .operators.blend_file import BLEND

    return cli.main(argv, formats=[BLEND], evaluate=_evaluate)


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
