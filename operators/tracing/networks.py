"""Which trained networks came with the extension."""

from __future__ import annotations

from pathlib import Path

_FILES = (
    ("Line finder", "centerline.onnx"),
    ("Lean line finder", "centerline_lean.onnx"),
    ("Junction router", "routing.onnx"),
)


def found_networks() -> list[tuple[str, str]]:
    """Name and path of each network; the path is empty where it is missing."""
    folder = Path(__file__).parents[2] / "engine" / "weights"
    return [(name, str(folder / file) if (folder / file).exists() else "") for name, file in _FILES]
