"""What `mkdocs` does besides."""

from __future__ import annotations

from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[1]


def on_startup(**_: Any) -> None:
    """Make build/api/involute: what is documented of the sources, under their importable name.

    The whole repository would be read with its environments.
    """
    package = ROOT / "build" / "api" / "involute"
    package.mkdir(parents=True, exist_ok=True)
    for name in ("__init__.py", "engine", "command"):
        link = package / name
        if not link.exists():
            link.unlink(missing_ok=True)
            link.symlink_to(ROOT / name, target_is_directory=(ROOT / name).is_dir())


def on_page_markdown(markdown: str, page: Any, **_: Any) -> str:
    """The changelog lies above docs/, and so do its links."""
    if page.file.src_uri != "changelog.md":
        return markdown
    return (ROOT / "CHANGELOG.md").read_text("utf-8").replace("](docs/", "](")
