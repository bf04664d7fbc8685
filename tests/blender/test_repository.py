"""A studio's repository: installed over http, updated with a file open and a trace running."""

from __future__ import annotations

import importlib.util
import os
import re
import shutil
import subprocess
import sys
import threading
import zipfile
from functools import partial
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path

import pytest

from .conftest import ROOT

bpy = pytest.importorskip("bpy")


class Quiet(SimpleHTTPRequestHandler):
    def log_message(self, *_: object) -> None:
        pass


@pytest.fixture
def package():
    """package.py, for a Blender that may lack the rest of our environment."""
    spec = importlib.util.spec_from_file_location("involute_package", ROOT / "package.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.fixture
def served(tmp_path):
    """(folder, URL) of an empty repository on this machine."""
    folder = tmp_path / "repository"
    folder.mkdir()
    handler = partial(Quiet, directory=str(folder))
    with ThreadingHTTPServer(("127.0.0.1", 0), handler) as server:
        threading.Thread(target=server.serve_forever, daemon=True).start()
        yield folder, f"http://127.0.0.1:{server.server_port}/index.json"
        server.shutdown()


def next_version(archive: Path, folder: Path) -> None:
    """The same zip once more, one version later."""
    path = folder / re.sub(r"-[\d.]+-", "-99.0.0-", archive.name)
    with zipfile.ZipFile(archive) as old, zipfile.ZipFile(path, "w") as new:
        for info in old.infolist():
            content = old.read(info)
            if info.filename == "blender_manifest.toml":
                content = re.sub(rb'(?m)^version = ".*"', b'version = "99.0.0"', content)
            new.writestr(info, content)


# Two downloads of the whole zip: in the oldest and the newest Blender that we support.
@pytest.mark.skipif(bpy.app.version[:2] == (5, 0), reason="tried in 4.5 and 5.2")
def test_installed_and_updated_over_http(archive, package, served, tmp_path, monkeypatch):
    folder, url = served
    (folder / "involute-0.0.1-linux_x64.zip").write_bytes(b"long ago")
    shutil.copy(archive, folder)
    package.list_repository(folder)
    assert [path.name for path in (folder / "older").iterdir()] == ["involute-0.0.1-linux_x64.zip"]
    assert f"./{archive.name}?repository=.%2Findex.json" in (folder / "index.html").read_text()

    second = tmp_path / "second"
    second.mkdir()
    next_version(archive, second)
    package._blender_extension("server-generate", f"--repo-dir={second}", "--html")
    environment = {**os.environ, "BLENDER_USER_RESOURCES": str(tmp_path / "user")}
    (tmp_path / "user").mkdir()
    script = Path(__file__).with_name("update_over_http.py")
    command = [sys.executable, str(script), url, str(second), str(folder), str(tmp_path)]
    ran = subprocess.run(command, env=environment, capture_output=True, text=True)
    assert "ALL WELL" in ran.stdout, ran.stdout[-3000:] + ran.stderr[-3000:]
    assert "Traceback" not in ran.stderr + ran.stdout, ran.stdout[-3000:] + ran.stderr[-3000:]
