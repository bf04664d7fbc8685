"""How large a picture may be, for every reader."""

from __future__ import annotations

MAX_SIDE = 20_000  # px


class TooLargeError(Exception):
    """A picture has a longer side; whoever knows its name says so."""
