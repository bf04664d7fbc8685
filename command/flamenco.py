"""Flamenco, the render farm of Blender's users: the job type `involute_trace.js` that we bring."""

from __future__ import annotations

from contextlib import suppress
from pathlib import Path

from ..engine.errors import InvoluteError
from ..engine.formats.whole_file import whole_file
from .planning import make_folder

JOB_TYPE = "involute_trace.js"
_LABEL = "Involute: Trace Drawings"


def write_job_type(folder: Path) -> Path:
    """Put the job type into a Manager's folder `scripts`; an older one of ours is replaced.

    Raises:
        InvoluteError: the folder can't be made or written, or another file of that name is there.
    """
    path = make_folder(folder) / JOB_TYPE
    if path.exists():
        text = ""
        with suppress(OSError, UnicodeDecodeError):
            text = path.read_text("utf-8")
        if _LABEL not in text:
            raise InvoluteError(f"{path} exists and is no job type of Involute; move it away.")
    script = Path(__file__).with_name(JOB_TYPE).read_bytes()
    with whole_file(path) as part:
        part.write_bytes(script)
    return path
