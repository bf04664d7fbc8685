"""Trace scans with an installed Involute, without a window, and save one .blend per scan.

    blender -b -P examples/trace_in_blender.py -- SCAN [SCAN ...] --output FOLDER

A start for scripts of your own: all settings of the sidebar are arguments of involute.trace.
"""

import argparse
import sys
from pathlib import Path

import bpy


def main(arguments: list[str]) -> int:
    parser = argparse.ArgumentParser(prog="blender -b -P trace_in_blender.py --")
    parser.add_argument("scans", nargs="+", type=Path)
    parser.add_argument("--output", type=Path, default=Path())
    options = parser.parse_args(arguments)
    options.output.mkdir(parents=True, exist_ok=True)
    failed = 0
    for scan in options.scans:
        bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
        try:
            bpy.ops.involute.trace(filepath=str(scan.absolute()))
        except RuntimeError as problem:
            print(f"{scan}: {str(problem).strip()}", file=sys.stderr)
            failed += 1
            continue
        target = (options.output / f"{scan.stem}.blend").absolute()
        bpy.ops.wm.save_as_mainfile(filepath=str(target), check_existing=False)
    return 1 if failed else 0


if __name__ == "__main__":
    after = sys.argv.index("--") + 1 if "--" in sys.argv else len(sys.argv)
    sys.exit(main(sys.argv[after:]))
