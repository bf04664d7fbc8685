"""The two exceptions of the engine: one for people to read, one for stopping half-way."""

from __future__ import annotations


class InvoluteError(Exception):
    """Something the user can act on; the message is one sentence that says what to do."""


class Cancelled(Exception):  # noqa: N818 - not an error: the user asked for it
    """Raised by a progress callback to stop the work; nothing has been changed."""
