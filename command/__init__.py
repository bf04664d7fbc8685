"""The `involute` command: what to trace into what, in how many processes, and what was done before.

Nothing of the method is in here; `trace_sequence` is the one thing for Python users.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from .sequence_tracing import trace_sequence

__all__ = ["trace_sequence"]


def __getattr__(name: str) -> Any:
    if name != "trace_sequence":
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    from .sequence_tracing import trace_sequence  # brings in OpenCV

    return trace_sequence
