"""A folder of numbered drawings -> one drawing per frame, with strokes that stay themselves.

frames: names -> frame numbers. matching: which stroke is which from frame to frame. follow: order,
direction and colour taken over from the frame before. trace: all of it, in parallel processes.
command: `involute trace --sequence`.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from .frames import Frame, FrameRange, number_frames, number_pages

if TYPE_CHECKING:
    from .trace import trace_sequence

__all__ = ["Frame", "FrameRange", "number_frames", "number_pages", "trace_sequence"]


def __getattr__(name: str) -> Any:
    if name != "trace_sequence":
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    from .trace import trace_sequence  # brings in OpenCV

    return trace_sequence
