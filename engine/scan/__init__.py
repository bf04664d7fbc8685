"""Any picture of a drawing -> `Scan`: read, polarity, paper, pen, marks."""

from __future__ import annotations

from .image_file import page_count
from .preparing import read_scan

__all__ = ["page_count", "read_scan"]
