"""Files chosen in the file browser, or dropped on the viewport."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path

import bpy
from bpy.props import CollectionProperty, StringProperty
from bpy_extras.io_utils import ImportHelper

from ...engine.formats.picture_kinds import SUFFIXES
from ..language import reported

TRACED = (*SUFFIXES, ".svg")  # an SVG's lines are taken as they are and routed anew


def files_shown(suffixes: Sequence[str]) -> object:
    """The property that tells Blender's file browser which files to show."""
    return StringProperty(default=";".join(f"*{suffix}" for suffix in suffixes), options={"HIDDEN"})


class ChosenFiles:
    """Mixin: what Blender fills in when files are chosen."""

    directory: StringProperty(subtype="DIR_PATH", options={"SKIP_SAVE", "HIDDEN"})
    files: CollectionProperty(
        type=bpy.types.OperatorFileListElement, options={"SKIP_SAVE", "HIDDEN"}
    )

    @property
    def names(self) -> list[str]:
        """The files of the directory that were chosen."""
        return [file.name for file in self.files if file.name]


class Handing:
    """Mixin for operators that find pictures and hand them to the operator that traces."""

    def hand_to(self, operator: Callable[..., set[str]], **options: object) -> set[str]:
        """Run another operator, in the background where there is a window; pass on its report."""
        way = "EXEC_DEFAULT" if bpy.app.background else "INVOKE_DEFAULT"
        try:
            result = operator(way, **options)
        except RuntimeError as problem:
            self.report({"ERROR"}, reported(problem))
            return {"CANCELLED"}
        return {"CANCELLED"} if result == {"CANCELLED"} else {"FINISHED"}


class FileChoice(Handing, ChosenFiles, ImportHelper):
    """Mixin for operators that let the user choose pictures and hand them to another operator."""

    bl_options = {"REGISTER"}  # the trace that they start is the step to undo

    filename_ext = ""
    filter_glob: files_shown(TRACED)

    @property
    def folder(self) -> str:
        """The folder that was chosen."""
        return self.directory or str(Path(self.filepath).parent)
