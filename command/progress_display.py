"""What the command says while it works: on a terminal a bar and a line per image, else trouble."""

from __future__ import annotations

import sys
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from .batch import Outcome

QUIET, USUAL, VERBOSE = -1, 0, 1


def say(sentence: str) -> None:
    """Print one line to the standard error, with the program's name."""
    if sys.stderr is not None:
        line = " ".join(sentence.split("\n"))
        print(f"involute: {line}", file=sys.stderr, flush=True)


class ProgressDisplay:
    """A progress bar on a terminal, nothing elsewhere; lines go above it, to the standard error.

    Trouble is always told. What became of an image is told on a terminal, or when asked for.

    Args:
        total: images that there are.
        loudness: QUIET, USUAL or VERBOSE.
        tells: USUAL says what became of an image even where there is no terminal.
    """

    def __init__(self, total: int, loudness: int = USUAL, *, tells: bool = False) -> None:
        terminal = sys.stderr is not None and sys.stderr.isatty()
        self._tells = loudness > USUAL or (loudness == USUAL and (terminal or tells))
        self._warns = loudness > QUIET
        self._stages = loudness > USUAL
        self._bar = _bar(total) if terminal and loudness > QUIET else None
        self._finished = 0

    def __enter__(self) -> ProgressDisplay:
        return self

    def __exit__(self, *error: object) -> None:
        if self._bar is not None:
            self._bar.close()

    def stage(self, name: str, fraction: float) -> None:
        """Show how far the image in hand has come."""
        self._move(fraction)
        if self._bar is not None:
            self._bar.set_postfix_str(name, refresh=False)

    def working_on(self, name: str) -> None:
        """Show which image is in hand."""
        if self._bar is not None:
            self._bar.set_description_str(name, refresh=False)

    def done(self, name: str, outcome: Outcome, outputs: Sequence[Path] = ()) -> None:
        """One image more is finished: say what became of it."""
        self._finished += 1
        self.working_on(name)
        self._move(0.0)
        if outcome.error:
            self.trouble(f"{name}: {outcome.error}")
            return
        if self._tells:
            self._line(f"{name}: {figures(outcome)}{_where(outputs)}")
            if self._stages:
                self._details(outcome.report)
        if not outcome.report.get("strokes", 1) and not outcome.report.get("warnings"):
            self.warning(f"{name}: warning: there are no lines; the drawing is empty.")
        for sentence in outcome.report.get("warnings", ()):
            self.warning(f"{name}: warning: {sentence}")
        for output in outcome.kept:
            self.warning(
                f"{name}: warning: {output} was edited since and stays; --overwrite replaces it."
            )

    def _details(self, report: Mapping[str, Any]) -> None:
        for sentence in report.get("notes", ()):
            self._line(f"    {sentence}")
        if report.get("seconds"):
            self._line(f"    {_seconds(report['seconds'])}")

    def warning(self, sentence: str) -> None:
        """Say something that is worth knowing, unless nothing is to be heard."""
        if self._warns:
            self._line(sentence)

    def trouble(self, sentence: str) -> None:
        """Say what went wrong."""
        self._line(sentence)

    def _line(self, sentence: str) -> None:
        if self._bar is not None:
            self._bar.clear()
        say(sentence)

    def _move(self, fraction: float) -> None:
        if self._bar is not None:
            self._bar.update(self._finished + fraction - self._bar.n)


def figures(outcome: Outcome) -> str:
    """What is in a drawing, in a few words."""
    report = outcome.report
    said = [_many(report.get("strokes", 0), "stroke")]
    said.append(_many(report.get("doubtful", 0), "doubtful junction"))
    if (lost := report.get("lost")) is not None:
        said.append(f"{100 * (1 - lost):.1f} % of the ink")
    if outcome.resumed:
        said.append("done before")
    return ", ".join(said)


def _many(count: int, what: str) -> str:
    return f"{count:,} {what}{'' if count == 1 else 's'}"


def _where(outputs: Sequence[Path]) -> str:
    return f" -> {', '.join(output.name for output in outputs)}" if outputs else ""


def _seconds(seconds: Mapping[str, float]) -> str:
    return ", ".join(f"{stage} {value:.2f} s" for stage, value in seconds.items())


def _bar(total: int) -> Any:
    try:
        from tqdm import tqdm
    except ImportError:  # Blender has none
        return None
    layout = "{desc} {percentage:3.0f}% {bar} {elapsed} < {remaining} {postfix}"
    return tqdm(total=total, bar_format=layout, leave=False, dynamic_ncols=True)
