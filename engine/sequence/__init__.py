"""A folder of numbered drawings -> one drawing per frame, with strokes that stay themselves.

frames: names -> frame numbers. matching: which stroke is which from frame to frame. follow: order,
direction and colour taken over from the frame before. trace: all of it, in parallel processes.
"""

from __future__ import annotations

from .frames import Frame, FrameRange, number_frames, number_pages
from .trace import trace_sequence

__all__ = ["Frame", "FrameRange", "number_frames", "number_pages", "trace_sequence"]
