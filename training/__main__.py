"""Training and all that belongs to it, by name: `python -m training run NAME [options]`.

Every run has its own options: `python -m training run NAME --help`.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from importlib import import_module

# Name -> (module, what it does). Each module's main(argv) is its command line.
RUNS = {
    "centerline": ("centerline.train_centerline", "train the centerline network, or go on"),
    "centerline-sheet": ("centerline.contact_sheet", "look at 100 of its training pages"),
    "centerline-losses": ("centerline.compare_losses", "short trainings with other losses"),
    "centerline-average": ("centerline.average", "the mean of two networks"),
    "centerline-export": ("centerline.export_centerline", "write what the engine ships"),
    "centerline-slim": ("centerline.slim", "leave out of a network what it does not use"),
    "centerline-validate": ("centerline.validate", "figures by medium, on held-out drawings"),
    "centerline-precision": ("centerline.precision", "how exactly ideal lines are found"),
    "centerline-stress": ("centerline.stress", "a picture of hard pages"),
    "traced": ("routing.traced", "pages as they are really traced, to learn routing from"),
    "routing": ("routing.train_routing", "train the routing network, or go on"),
    "routing-export": ("routing.export_routing", "calibrate it and write what the engine ships"),
    "routing-geometric": ("routing.geometric_fit", "fit the weights of the geometric router"),
    "corners": ("corners.train_corners", "learn where the pen was lifted, or go on"),
    "undrawn": ("undrawn.train_undrawn", "learn which branches nobody drew"),
    "second-lines": ("second_lines.train_second_lines", "learn which runs carry two strokes"),
    "rough": ("rough.train_rough", "learn how many pencil strokes become one line"),
    "digests": ("digests", "note what the shipped weights contain"),
}


def main(argv: Sequence[str] | None = None) -> None:
    """The command line."""
    parser = argparse.ArgumentParser(
        prog="python -m training",
        description=__doc__,
        formatter_class=argparse.RawDescriptionHelpFormatter,
        epilog="runs:\n" + "\n".join(f"  {name:22} {what}" for name, (_, what) in RUNS.items()),
    )
    parser.add_argument("command", choices=["run"])
    parser.add_argument("name", choices=list(RUNS), metavar="NAME")
    parser.add_argument("rest", nargs=argparse.REMAINDER, metavar="options")
    options = parser.parse_args(argv)
    module, _ = RUNS[options.name]
    import_module(f"involute.training.{module}").main(options.rest)


if __name__ == "__main__":
    main(sys.argv[1:])
