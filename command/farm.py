"""A render farm's job: an Open Job Description bundle that traces a sequence on many machines.

The format is open (specification jobtemplate-2023-09 with the extension TASK_CHUNKING): AWS
Deadline Cloud runs it as it is, and `openjd run` does on one machine. The first step traces chunks
of frames into parts, the second waits for all of them and joins the parts; both are the ordinary
command line, so a job that was stopped goes on where it was.
"""

from __future__ import annotations

import json
import shlex
from collections.abc import Iterable, Sequence
from contextlib import suppress
from pathlib import Path
from typing import Any

from ..engine.errors import InvoluteError
from ..engine.formats.whole_file import whole_file, write_text
from .planning import make_folder

TEMPLATE, VALUES = "template.json", "parameter_values.json"
_VERSION = "jobtemplate-2023-09"
_LONGEST = 1024  # characters of a parameter's value


def write_job(
    folder: Path,
    images: Path,
    output: Path,
    numbers: Sequence[int],
    *,
    options: Iterable[str] = (),
    chunk: int = 10,
    command: str = "involute",
) -> Path:
    """Write the bundle: template.json, and parameter_values.json for Deadline Cloud.

    Args:
        folder: where the bundle goes; made when missing.
        images: the folder of images, or one file with all of them.
        output: the .blend, or a folder of drawings, that the job makes.
        numbers: the numbers of the drawings to trace.
        options: more arguments for `involute trace`.
        chunk: drawings that one task traces.
        command: how a worker calls Involute; `blender -b --command involute` where it is installed
            as an extension.

    Raises:
        InvoluteError: the bundle can't be written, or the command or a name can't be put into it.
    """
    try:
        words = shlex.split(command)
    except ValueError as error:
        raise InvoluteError(f"Can't read the command {command!r}: {error}.") from None
    if not words:
        raise InvoluteError("Say how the workers call Involute, such as --call involute.")
    if chunk < 1:
        raise InvoluteError("A chunk must hold at least one frame.")
    options = list(options)
    paths = {"Images": images, "OutputDir": output.parent}
    values = {name: path.absolute().as_posix() for name, path in paths.items()}
    for text in (*words, *options, output.name, *values.values()):
        _check_text(text)
    template = _template(words, options, output, images.is_dir(), frame_ranges(numbers), chunk)
    # The format wants paths from the one who submits: defaults may not be absolute.
    given = [{"name": name, "value": value} for name, value in values.items()]
    make_folder(folder)
    files = {folder / TEMPLATE: template, folder / VALUES: {"parameterValues": given}}
    for path in files:
        _check_free(path)
    for path, content in files.items():
        with whole_file(path) as part:
            write_text(json.dumps(content, indent=2) + "\n", part)
    return folder / TEMPLATE


def _check_text(text: str) -> None:
    """Refuse what a farm would read as something else.

    Raises:
        InvoluteError: says what.
    """
    if "{{" in text or "}}" in text:
        raise InvoluteError(f"{text[:60]!r} would be a parameter to a farm; choose another name.")
    if any(ord(sign) < 32 or ord(sign) == 127 or 0xD800 <= ord(sign) < 0xE000 for sign in text):
        raise InvoluteError(f"{text[:60]!r} is no text for a farm; choose another name.")
    if len(text) > _LONGEST:
        raise InvoluteError(f"{text[:60]!r} is too long for a farm; choose a shorter name.")


def _check_free(path: Path) -> None:
    """Refuse to replace a file that is not of a job.

    Raises:
        InvoluteError: it stands there.
    """
    if not path.exists():
        return
    text = ""
    with suppress(OSError, UnicodeDecodeError):
        text = path.read_text("utf-8")
    if _VERSION not in text and '"parameterValues"' not in text:
        raise InvoluteError(f"{path} exists and is not of a job; choose another folder.")


def _template(
    words: Sequence[str],
    options: Sequence[str],
    output: Path,
    many_images: bool,
    frames: str,
    chunk: int,
) -> dict[str, Any]:
    """The job: trace chunks, then join them."""
    program, first = words[0], [*words[1:], "trace", "{{Param.Images}}", "--sequence"]
    first += ["--parts", "{{Param.OutputDir}}/parts", "--skip-failed", *options]
    report = ["--report", f"{{{{Param.OutputDir}}}}/{output.stem}-report.json", "--overwrite"]
    target = ["-o", f"{{{{Param.OutputDir}}}}/{output.name}"]
    chunks = {
        "name": "Frame",
        "type": "CHUNK[INT]",
        "range": "{{Param.Frames}}",
        "chunks": {
            "defaultTaskCount": "{{Param.ChunkSize}}",
            "rangeConstraint": "CONTIGUOUS",
        },
    }
    tracing = [*first, "--frames", "{{Task.Param.Frame}}", "--jobs", "0"]
    joining = [*first, "--frames", "{{Param.Frames}}", *target, *report]
    return {
        "specificationVersion": _VERSION,
        "extensions": ["TASK_CHUNKING"],
        "name": f"Involute {output.stem}"[:128],
        "description": "Traces a sequence of scanned drawings.",
        "parameterDefinitions": [
            _path("Images", "IN", many_images, "The scanned drawings"),
            _path("OutputDir", "OUT", True, "Where the drawing goes"),
            _value("Frames", "STRING", frames, "Numbers of the drawings"),
            {**_value("ChunkSize", "INT", chunk, "Drawings that one task traces"), "minValue": 1},
        ],
        "steps": [
            {
                "name": "Trace",
                "parameterSpace": {"taskParameterDefinitions": [chunks]},
                "script": _script(program, tracing),
            },
            {
                "name": "Join",
                "dependencies": [{"dependsOn": "Trace"}],
                "script": _script(program, joining),
            },
        ],
    }


def frame_ranges(numbers: Iterable[int]) -> str:
    """Numbers as Open Job Description writes them: 1-7,9-20.

    With so many holes that it would be too long, all from the first to the last: a task that finds
    no images has nothing to do.
    """
    spans: list[list[int]] = []
    for number in sorted(numbers):
        if spans and number == spans[-1][1] + 1:
            spans[-1][1] = number
        else:
            spans.append([number, number])
    text = ",".join(f"{a}-{b}" if b > a else f"{a}" for a, b in spans)
    return text if len(text) <= _LONGEST else f"{spans[0][0]}-{spans[-1][1]}"


def _path(name: str, flow: str, is_folder: bool, label: str) -> dict[str, Any]:
    return {
        "name": name,
        "type": "PATH",
        "objectType": "DIRECTORY" if is_folder else "FILE",
        "dataFlow": flow,
        "userInterface": {
            "control": "CHOOSE_DIRECTORY" if is_folder else "CHOOSE_INPUT_FILE",
            "label": label,
        },
    }


def _value(name: str, kind: str, value: Any, label: str) -> dict[str, Any]:
    control = "SPIN_BOX" if kind == "INT" else "LINE_EDIT"
    return {
        "name": name,
        "type": kind,
        "default": value,
        "userInterface": {"control": control, "label": label},
    }


def _script(program: str, words: list[str]) -> dict[str, Any]:
    return {"actions": {"onRun": {"command": program, "args": words}}}
