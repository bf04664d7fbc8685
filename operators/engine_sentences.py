"""What the engine says of pictures and drawings, so that it is seen in the user's language.

The engine knows nothing of languages: its sentences come ready made, with names and numbers in
them. Here they are recognised by their templates, {0}, {1} ... standing for what is filled in.
"""

from __future__ import annotations

import re
from functools import cache

from bpy.app.translations import pgettext_iface, pgettext_rpt

from ..engine.settings import ABOUT

SENTENCES = (
    "Traced as light lines on dark; if the ink is dark, try --polarity dark.",
    (
        "{0} of the ink is not in the drawing; try --provider classical, or a smaller "
        "--min-length where dots and specks are missing."
    ),
    (
        "{0} of the length of the strokes runs over bare paper; raise --min-length, or set "
        "--pen-width."
    ),
    "Taken for a rough drawing: its {0} pencil strokes say {1} lines.",
    "The pencil strokes of a bundle are one line or two.",
    "No pencil strokes of these lines run beside each other.",
    "This drawing does not know what its lines were made of; trace the picture again.",
    "This stroke ends there already.",
    "To join, two different ends of strokes are needed.",
    "Only ends can be joined; cut the stroke that goes on there first.",
    "Only ends that meet, or that hang on nothing, can be joined.",
    "{0} filled shapes were left out.",
    "What lies beyond the sheet was left out: {0} of the picture.",
    "The sheet was not straightened: its four corners are not sure.",
    "The sheet was straightened: its corners were {0}° askew.",
    "What shows through from the back was left out: {0} of the ink.",
    "Printed rules were left out.",
    "The lines are grainy: traced from farther away (--grain {0}).",
    (
        "The picture has white areas and is not of centerlines, thin white lines on black; "
        "choose another --provider."
    ),
    "Left out as no part of the drawing: {0}.",
    "dark borders of the scan",
    "{0} punched holes",
    "{0} registration marks",
    "There are no peg holes or registration marks on {0}; trace it without aligning.",
    "Screentone was left out: {0} of the page.",
    "{0} is damaged; give a whole {1} file.",
    "{0} is not a picture of a kind that is read; give {1}.",
    "{0} is {1}, which is not read; {2}.",
    "save it as PNG or TIFF first",
    "save its pages as PNG or TIFF first, at 300 dpi (pdftoppm -r 300 -png does it)",
    "save it as PNG or JPEG first; a phone can also be set to take JPEG",
    "{0} is {1}; give an image file (or - for a pipe).",
    "a folder",
    "no file",
    "There is no file {0}; check the path.",
    "Can't read {0}: {1}.",
    "{0} can't be the name of a file.",
    "{0} is too large to be read; scale it down to at most 20,000 px a side.",
    "{0} is only {1} x {2} px; give a picture of at least {3} x {4} px.",
    "{0} is {1} x {2} px; scale it down to at most {3} px a side.",
    "{0} holds values that aren't numbers; replace the NaN first.",
    (
        "The picture is black all over; scan the page again, or choose polarity 'light' if "
        "it is an empty blackboard."
    ),
    "{0} says it has {1} images; it is damaged.",
    "{0} has no image {1} that can be read.",
    "{0} is not a movie that can be read.",
    "the PSD holds no flattened picture; save it with 'Maximize Compatibility', or as PNG.",
    (
        "The weights of the centerline network ({0}) are missing; reinstall Involute, or "
        "choose the classical provider."
    ),
    "Found no GPU that torch can use; choose the device 'auto' or 'cpu'.",
    "Can't read the weights in {0}.",
    "The weights of the routing network are missing or damaged.",
    "The names {0} and {1} are not of one sequence; give the files of one sequence.",
    "The names {0} and {1} differ in more than one number; give the files of one sequence.",
    "{0} and {1} are both drawing {2}; give the files of one sequence.",
    "Frame {0} is beyond what a timeline holds ({1}); choose another start or step.",
    "{0} declares entities; save it as plain SVG first.",
    "There is no line in {0}; pictures inside of an SVG are not read.",
    "{0} isn't an SVG that can be read ({1}); save it anew.",
)
_OPTION = re.compile(r"--([a-z]+(?:-[a-z]+)*)(?: ([a-z]+))?")


def in_their_words(text: str) -> str:
    """A sentence of the engine in the user's language, options by their names in the sidebar."""
    return _OPTION.sub(_named, _translated(text))


def _translated(text: str) -> str:
    """The sentence, or a phrase or list of phrases in it, in the user's language."""
    said = pgettext_rpt(text)
    if said != text:
        return said
    for template, pattern in _patterns():
        if found := pattern.fullmatch(text):
            inside = (", ".join(map(_phrase, part.split(", "))) for part in found.groups())
            return pgettext_rpt(template).format(*inside)
    return text


def _phrase(text: str) -> str:
    """What is filled in may be words, too."""
    return text if any(mark in text for mark in "/\\") else _translated(text)


@cache
def _patterns() -> tuple[tuple[str, re.Pattern[str]], ...]:
    """Templates and what they match, those with the most words of their own first."""
    made = []
    for template in sorted(SENTENCES, key=lambda s: -len(re.sub(r"{\d}", "", s))):
        if "{0}" in template:
            parts = re.split(r"{\d}", template)
            made.append((template, re.compile("(.+?)".join(map(re.escape, parts)), re.DOTALL)))
    return tuple(made)


def _named(option: re.Match[str]) -> str:
    """An option of the command line as the sidebar calls it."""
    about = ABOUT.get(option[1].replace("-", "_"))
    if about is None:
        return option[0]
    name = pgettext_iface(about.label)
    choice = next((c for c in about.choices if c.value == option[2]), None)
    if choice is None:
        return f"“{name}”" + (f" {option[2]}" if option[2] else "")
    return f"“{name}: {pgettext_iface(choice.label)}”"
