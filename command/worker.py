"""The process behind `batch`: reads one task a line, traces it, answers with one line of JSON.

Started by file name, not as a module: inside Blender the package goes by a name that only
Blender's own import system can find.
"""

from __future__ import annotations

import importlib
import importlib.util
import json
import os
import signal
import sys
import threading
from pathlib import Path
from queue import SimpleQueue
from types import ModuleType
from typing import TextIO

_PACKAGE = "involute_worker"


def main() -> None:
    """Answer tasks until the other side goes away."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C is for the parent, which then ends us
    # Whatever a library prints must not get between the answers.
    answers = os.fdopen(os.dup(1), "w", encoding="utf-8")
    os.dup2(2, 1)
    hello = json.loads(sys.stdin.readline())
    sys.path[:] = hello["path"]
    tasks: SimpleQueue[dict] = SimpleQueue()
    threading.Thread(target=_listen, args=(sys.stdin, tasks), daemon=True).start()
    batch = _module("command.batch")
    settings = _module("engine.settings").Settings
    cv2 = importlib.import_module("cv2")
    cv2.setNumThreads(hello["threads"])
    while True:
        asked = tasks.get()
        task = batch.Task(
            asked["source"],
            tuple(asked["outputs"]),
            settings(**asked["settings"]),
            asked["page"],
            asked["receipt"],
            asked["turn"],
            asked["stretch"],
        )
        answers.write(json.dumps(batch.perform(task)) + "\n")
        answers.flush()


def _listen(lines: TextIO, tasks: SimpleQueue[dict]) -> None:
    """Pass tasks on; when the parent is gone, so are we, in the middle of an image or not."""
    for line in lines:
        tasks.put(json.loads(line))
    os._exit(0)


def _module(module: str) -> ModuleType:
    """A module of the package that this file lies in."""
    if _PACKAGE not in sys.modules:
        folder = Path(__file__).resolve().parents[1]
        spec = importlib.util.spec_from_file_location(
            _PACKAGE, folder / "__init__.py", submodule_search_locations=[str(folder)]
        )
        package = importlib.util.module_from_spec(spec)
        sys.modules[_PACKAGE] = package
        spec.loader.exec_module(package)
    return importlib.import_module(f"{_PACKAGE}.{module}")


if __name__ == "__main__":
    main()
