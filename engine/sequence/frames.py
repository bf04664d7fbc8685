"""Which image is which frame: numbers taken from the names, gaps kept as holds."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import pairwise
from os import PathLike, fspath
from pathlib import Path

from ..errors import InvoluteError

_DIGITS = re.compile(r"\d+")
_SPARSEST = 100  # numbers farther apart than this are times of day or serials, not frames
_LAST = 1_048_574  # Blender's last frame, and the negative of its first
_RANGE = re.compile(r"\s*(\d{1,18})(?:\s*-\s*(\d{1,18}))?(?:\s*[:x]\s*(\d{1,18}))?\s*")


@dataclass(frozen=True)
class Frame:
    """One image of a sequence.

    number: the drawing's own number, as written in its name.
    frame: where its keyframe goes on the timeline.
    page: which page of a TIFF, or image of a movie clip.
    """

    number: int
    frame: int
    path: str
    page: int = 0


@dataclass(frozen=True)
class FrameRange:
    """A choice of drawing numbers such as 101-200, 1-48:2 or 1-5,9,12-20."""

    parts: tuple[range, ...]

    @staticmethod
    def parse(text: str) -> FrameRange:
        """Read numbers, spans FIRST-LAST and stepped spans FIRST-LAST:STEP, with commas between.

        Raises:
            InvoluteError: the text is not such a list.
        """
        parts = []
        for piece in text.split(","):
            match = _RANGE.fullmatch(piece)
            first, last, step = 0, 0, 0
            if match:
                first = int(match[1])
                last, step = int(match[2] or first), int(match[3] or 1)
            if not match or last < first or step == 0:
                raise InvoluteError(
                    f"Can't read the frames {text[:40]!r}; "
                    "write for example 101-200 or 1-48:2 or 1,5,9."
                )
            parts.append(range(first, last + 1, step))
        return FrameRange(tuple(parts))

    def __contains__(self, number: int) -> bool:
        return any(number in part for part in self.parts)


def number_frames(
    paths: Iterable[str | PathLike[str]],
    *,
    start: int | None = None,
    step: int = 1,
    frames: FrameRange | None = None,
) -> list[Frame]:
    """Give every image of one sequence its place on the timeline, in order of the numbers.

    A number missing from the names leaves its frame without a keyframe, so that the drawing before
    it is held. Without any numbers the files are counted from 1, in the order given.

    Args:
        paths: the image files of ONE sequence.
        start: the frame of the first drawing; None = its own number.
        step: frames from one number to the next; 2 puts drawings "on twos".
        frames: keep only these drawings; the others still count for `start`, so that chunks of a
            sequence land where the whole would.

    Raises:
        InvoluteError: the names are not those of one sequence, or a frame is beyond any timeline.
    """
    files = [fspath(p) for p in paths]
    numbers = _numbers([Path(p).stem for p in files])
    ordered = sorted(zip(numbers, files, strict=True))
    for (number, path), (following, other) in pairwise(ordered):
        if number == following:
            raise InvoluteError(
                f"{Path(path).name} and {Path(other).name} are both drawing {number}; "
                "give the files of one sequence."
            )
    first = ordered[0][0] if ordered else 0
    origin = first if start is None else start
    return _on_timeline(
        [
            Frame(number, origin + (number - first) * step, path)
            for number, path in ordered
            if frames is None or number in frames
        ],
        step,
    )


def number_pages(
    path: str | PathLike[str],
    count: int,
    *,
    start: int | None = None,
    step: int = 1,
    frames: FrameRange | None = None,
) -> list[Frame]:
    """The same for one file that holds all the drawings: the pages of a TIFF, a movie clip."""
    origin = 1 if start is None else start
    return _on_timeline(
        [
            Frame(page + 1, origin + page * step, fspath(path), page)
            for page in range(count)
            if frames is None or page + 1 in frames
        ],
        step,
    )


def _on_timeline(frames: list[Frame], step: int) -> list[Frame]:
    if step < 1:
        raise InvoluteError("The step between frames must be 1 or more.")
    for frame in frames:
        if abs(frame.frame) > _LAST:
            raise InvoluteError(
                f"Frame {frame.frame} is beyond what a timeline holds ({_LAST:,}); "
                "choose another start or step."
            )
    return frames


def _numbers(stems: Sequence[str]) -> list[int]:
    """The number of each drawing: of the digits in the names, the last group that differs."""
    groups = [_DIGITS.findall(stem) for stem in stems]
    if not any(groups):
        return list(range(1, len(stems) + 1))
    patterns = {_DIGITS.sub("#", stem).casefold(): stem for stem in stems}
    if len(patterns) > 1:
        one, other, *_ = patterns.values()
        raise InvoluteError(
            f"The names {one} and {other} are not of one sequence; give the files of one sequence."
        )
    values = [tuple(int(digits) for digits in group) for group in groups]
    varying = [k for k, column in enumerate(zip(*values, strict=True)) if len(set(column)) > 1]
    numbers = [v[varying[-1] if varying else -1] for v in values]
    if len(varying) > 1 and len(set(numbers)) < len(numbers):
        raise InvoluteError(
            f"The names {stems[0]} and {stems[-1]} differ in more than one number; "
            "give the files of one sequence."
        )
    sparse = max(numbers) - min(numbers) > _SPARSEST * len(numbers)
    if len(varying) > 1 or sparse or max(numbers) > _LAST:  # times of day, dates
        ranks = {value: rank for rank, value in enumerate(sorted(values), 1)}
        return [ranks[value] for value in values]
    return numbers
