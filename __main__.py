"""`involute` and `python -m involute`: the engine's command line, with all that the engine may not
import handed to it: Blender for .blend files, the benchmark's metrics for `evaluate`.
"""

from __future__ import annotations

import signal
import sys
import threading
from collections.abc import Mapping, Sequence
from pathlib import Path


def main(argv: Sequence[str] | None = None) -> int:
    """Run the command line; see `command.cli.main`."""
    usual = signal.getsignal(signal.SIGINT) is signal.default_int_handler
    alone = usual and threading.current_thread() is threading.main_thread()
    if alone:
        signal.signal(signal.SIGINT, signal.SIG_DFL)  # nothing to clear away yet: just end
    from .command import cli
    from .operators.blend_file import BLEND

    if alone:
        signal.signal(signal.SIGINT, signal.default_int_handler)
    return cli.main(argv, formats=[BLEND], evaluate=_evaluate)


def _evaluate(prediction: Path, truth: Path) -> Mapping[str, float]:
    from .engine import InvoluteError

    try:
        from .benchmarks import metrics
    except ImportError as error:
        raise InvoluteError(
            f"Evaluating needs a checkout of Involute and its extra 'bench' ({error})."
        ) from error
    from .engine.formats import read_text

    try:
        for path in (prediction, truth):
            if "<!ENTITY" in read_text(path):  # they can blow up a small file
                raise InvoluteError(f"{path.name} declares entities; save it without them.")
        strokes, true_strokes = metrics.read_svg(prediction), metrics.read_svg(truth)
    except (ArithmeticError, LookupError, RecursionError, SyntaxError, TypeError) as error:
        raise InvoluteError(f"Can't compare them: {str(error).rstrip('.')}.") from error
    except ValueError as error:
        raise InvoluteError(f"Can't compare them: {str(error).rstrip('.')}.") from error
    return metrics.summarize([metrics.evaluate(strokes, true_strokes)])


if __name__ == "__main__":
    sys.exit(main())
