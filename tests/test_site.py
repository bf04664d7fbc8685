"""The documentation as a site: it builds without a warning, and no link in it leads nowhere."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Iterator
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit

import pytest
from involute import package

ROOT = package.ROOT
pytest.importorskip("mkdocs", reason="needs the extra docs")


class Page(HTMLParser):
    """What a page refers to, what in it can be referred to, and what the browser fetches."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.links: list[str] = []
        self.fetched: list[str] = []
        self.anchors: set[str] = {"", "__codelineno"}
        self.feed(text)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        values = {name: value or "" for name, value in attrs}
        self.anchors |= {values.get("id", ""), values.get("name", "")}
        if tag == "a" and "href" in values:
            self.links.append(values["href"])
        elif tag == "link" and values.get("rel") != "canonical" and "href" in values:
            self.fetched.append(values["href"])
        elif "src" in values:
            self.fetched.append(values["src"])


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("site")
    command = [sys.executable, "-m", "mkdocs", "build", "--strict", "--site-dir", str(folder)]
    environment = {**os.environ, "NO_MKDOCS_2_WARNING": "1"}
    built = subprocess.run(command, cwd=ROOT, env=environment, capture_output=True, text=True)
    assert built.returncode == 0, built.stdout + built.stderr
    assert "WARNING" not in built.stderr, built.stderr
    return folder


def pages(site: Path) -> Iterator[tuple[Path, Page]]:
    for path in site.rglob("*.html"):
        if path.name != "404.html":
            yield path, Page(path.read_text("utf-8"))


def test_every_link_leads_somewhere(site: Path) -> None:
    found = dict(pages(site))
    assert len(found) > 25
    lost = []
    for path, page in found.items():
        for link in page.links + page.fetched:
            parts = urlsplit(link)
            if parts.scheme in ("http", "https", "mailto", "javascript", "data"):
                continue
            target = (path.parent / unquote(parts.path)).resolve() if parts.path else path
            anchors = found[target].anchors if target in found else {unquote(parts.fragment)}
            if not target.is_file() or unquote(parts.fragment) not in anchors:
                lost.append(f"{path.name}: {link}")
    assert lost == []


def test_nothing_is_fetched_from_elsewhere(site: Path) -> None:
    """It can be read without a network, and tells nobody who reads it."""
    for path, page in pages(site):
        for link in page.fetched:
            assert not urlsplit(link).netloc, f"{path.name}: {link}"


def test_the_reference_has_what_the_library_offers(site: Path) -> None:
    from involute import engine

    text = (site / "api.html").read_text("utf-8")
    for name in engine.__all__:
        assert f">{name}<" in text or f'.{name}"' in text, name
