"""Where weights come from: what a run was asked, and what it began with and learnt from.

A run keeps it in config.json; exporting copies it into `lineage.json` beside the weights, where an
entry holds for one content of a file alone. Standard library only.
"""

from __future__ import annotations

import argparse
import hashlib
import json
import subprocess
from pathlib import Path
from typing import Any

from involute.engine import weights

CONFIG = "config.json"
_ROOT = Path(__file__).resolve().parents[1]
_UNKNOWN = "not by an exporter of this repository"


def note_run(folder: Path, options: argparse.Namespace, **more: object) -> None:
    """Write config.json of a run: its options, the commit, the data, the weights it began with."""
    asked: dict[str, Any] = {k: _plain(v) for k, v in vars(options).items()}
    asked |= {"commit": commit(), "data_sha256": data_digest(options.data)}
    parent = getattr(options, "start", None) or getattr(options, "start_from", None)
    if parent:
        asked["parent"] = of_parent(parent)
    folder.mkdir(parents=True, exist_ok=True)
    (folder / CONFIG).write_text(json.dumps(asked | more, indent=1, default=str), "utf-8")


def _plain(value: object) -> object:
    """An option as it is kept: of a path its name alone, since where it lies says nothing to
    others and is shipped with the weights."""
    if isinstance(value, Path):
        return value.name
    if isinstance(value, list | tuple):
        return [_plain(one) for one in value]
    return value if isinstance(value, (int, float)) else str(value)


def of_parent(path: Path) -> dict[str, Any]:
    """What a run was started from: its digest and, where it is known, its own run."""
    found: dict[str, Any] = {"file": path.name, "sha256": sha256(path)}
    for config in (_of_weights(path), _of_run(path.parent)):
        if config:
            return found | {"run": config.get("run"), "commit": config.get("commit")}
    return found


def note_weights(path: Path, *runs: Path, slimmed_from: Path | None = None) -> None:
    """Say in lineage.json beside weights which runs (folders), or larger weights, they are from."""
    entries = read(path.parent)
    entry: dict[str, Any] = {"sha256": sha256(path), "exported_at": commit()}
    if slimmed_from:
        entry["slimmed_from"] = of_parent(slimmed_from)
    if runs or not slimmed_from:
        entry |= {"runs": [_of_run(run) for run in runs]} if runs else {"note": _UNKNOWN}
    entries[path.name] = entry
    write(path.parent, entries)


def write(folder: Path, entries: dict[str, Any]) -> None:
    """Write lineage.json for the weights that a folder holds."""
    known = {name: entries[name] for name in weights.names(folder) if name in entries}
    (folder / weights.LINEAGE).write_text(json.dumps(known, indent=1) + "\n", "utf-8")


def checked(folder: Path) -> dict[str, Any]:
    """The entries of lineage.json; weights that are others than it speaks of came by hand."""
    entries = read(folder)
    for name in weights.names(folder):
        digest = sha256(folder / name)
        if entries.get(name, {}).get("sha256") != digest:
            entries[name] = {"sha256": digest, "note": _UNKNOWN}
    return entries


def read(folder: Path) -> dict[str, Any]:
    """File name -> where it comes from; nothing where nobody said."""
    path = folder / weights.LINEAGE
    return json.loads(path.read_text("utf-8")) if path.exists() else {}


def _of_run(folder: Path) -> dict[str, Any]:
    path = folder / CONFIG
    config = json.loads(path.read_text("utf-8")) if path.exists() else {}
    return {"run": folder.name} | config if config else {}


def _of_weights(path: Path) -> dict[str, Any]:
    entry = read(path.parent).get(path.name, {})
    return next(iter(entry.get("runs", [])), {})


def data_digest(folder: Path) -> str:
    """A short digest of the drawings a run is trained on."""
    digest = hashlib.sha256()
    for path in sorted(folder.glob("*.npz")):
        digest.update(path.name.encode())
        digest.update(path.read_bytes())
    return digest.hexdigest()[:16]


def sha256(path: Path) -> str:
    """The SHA-256 of a file's content, in hexadecimal digits."""
    return hashlib.sha256(path.read_bytes()).hexdigest()


def commit() -> str:
    """The commit of these sources, "+" behind it when they differ from it; "" without git."""
    command = ["git", "describe", "--always", "--dirty=+", "--abbrev=10", "--exclude=*"]
    try:
        said = subprocess.run(command, cwd=_ROOT, capture_output=True, text=True, check=True)
    except (OSError, subprocess.CalledProcessError):
        return ""
    return said.stdout.strip()
