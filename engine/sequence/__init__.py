"""Numbered drawings -> frames, and strokes that stay themselves from frame to frame.

frames: names -> frame numbers. stroke_matching: which stroke is which from frame to frame. follow:
order, direction and colour taken over from the frame before; steady: how strokes are joined.
Tracing them in parallel processes is `command.trace_sequence`.
"""

from __future__ import annotations

from .frames import Frame, FrameRange, number_frames, number_pages

__all__ = ["Frame", "FrameRange", "number_frames", "number_pages"]
