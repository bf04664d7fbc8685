"""The one training loop: it stops, goes on, and leaves nothing half written; and where from."""

from __future__ import annotations

import json
from argparse import Namespace
from collections.abc import Iterator
from importlib import import_module
from inspect import signature
from pathlib import Path

import numpy as np
import pytest

pytest.importorskip("torch", reason="training needs torch")

import torch
from involute.engine import weights
from involute.training import digests, lineage
from involute.training.__main__ import RUNS
from involute.training.loop import Schedule, Training
from involute.training.page_bank import PageBank
from torch import Tensor, nn


def batches(first: int) -> Iterator[Tensor]:
    """Points of a line, the same ones for the same step."""
    step = first
    while True:
        yield torch.from_numpy(np.random.default_rng(step).normal(0, 1, (16, 2))).float()
        step += 1


def loss(net: nn.Module, batch: Tensor) -> dict[str, Tensor]:
    return {"total": (net(batch)[:, 0] - batch @ torch.tensor([2.0, -1.0])).square().mean()}


def trained(folder: Path, steps: int, **schedule: float) -> Training:
    torch.manual_seed(1)
    training = Training(folder, nn.Linear(2, 1), Schedule(300, rate=0.05, **schedule))
    whole = iter(batches(training.step))
    pieces = (next(whole) for _ in range(steps - training.step))
    training.run(pieces, loss, lambda net: {"slope": float(net.weight[0, 0])})
    return training


def test_a_stopped_run_goes_on_as_if_it_had_not_been_stopped(tmp_path: Path) -> None:
    whole = trained(tmp_path / "whole", 300)
    for stop in (1, 120, 300):
        pieces = trained(tmp_path / "pieces", stop)
    assert pieces.step == whole.step == 300
    torch.testing.assert_close(pieces.mean.weight, whole.mean.weight)
    torch.testing.assert_close(whole.mean.weight, torch.tensor([[2.0, -1.0]]), atol=0.2, rtol=0)
    log = [json.loads(row) for row in (tmp_path / "pieces" / "log.jsonl").read_text().splitlines()]
    assert log[-1]["step"] == 300
    assert log[-1]["slope"] == pytest.approx(2, abs=0.2)
    assert trained(tmp_path / "pieces", 400).step == 300  # it was over


def test_a_stop_while_writing_leaves_the_last_checkpoint(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    trained(tmp_path, 5)
    kept = (tmp_path / "checkpoint.pt").read_bytes()

    def stopped(state: object, path: Path) -> None:
        path.write_bytes(b"half")
        raise KeyboardInterrupt

    monkeypatch.setattr(torch, "save", stopped)
    with pytest.raises(KeyboardInterrupt):
        trained(tmp_path, 10)
    assert (tmp_path / "checkpoint.pt").read_bytes() == kept


def _square(number: int) -> int | None:
    return None if number % 3 == 2 else number * number


def test_a_bank_of_pages_goes_on_where_it_stopped(tmp_path: Path) -> None:
    def load(path: Path) -> tuple[list[int], int]:
        with np.load(path) as file:
            return file["found"].tolist(), int(file["tried"])

    def save(path: Path, found: list[int], tried: int) -> None:
        np.savez(path, found=found, tried=tried)

    bank = PageBank(tmp_path / "bank.npz", load, save, piece=2)
    assert bank.filled(3, _square) == [0, 1]
    assert bank.filled(8, _square) == [0, 1, 9, 16, 36, 49]
    assert [path.name for path in tmp_path.iterdir()] == ["bank.npz"]
    # When its time is over it writes what it has, and stops.
    assert bank.filled(100, _square, seconds=0.0) == [0, 1, 9, 16, 36, 49]
    assert load(tmp_path / "bank.npz")[1] == 9


def test_weights_say_which_run_they_are_from(tmp_path: Path) -> None:
    data, run, folder = (tmp_path / name for name in ("data", "run_7", "weights"))
    data.mkdir()
    folder.mkdir()
    (data / "set.npz").write_bytes(b"drawings")
    (folder / "old.onnx").write_bytes(b"parent")
    (folder / "digests.json").write_text("{}")
    lineage.note_run(run, Namespace(data=data, seed=3, start=folder / "old.onnx"), torch="2")
    (folder / "new.onnx").write_bytes(b"trained")
    digests.note(folder / "new.onnx", run)
    said = lineage.read(folder)["new.onnx"]["runs"][0]
    assert (said["run"], said["seed"], said["torch"]) == ("run_7", 3, "2")
    assert said["data_sha256"] == lineage.data_digest(data)
    assert said["parent"]["sha256"] == lineage.sha256(folder / "old.onnx")
    # What is replaced by hand is from no known run.
    (folder / "new.onnx").write_bytes(b"by hand")
    digests.write(folder)
    assert "runs" not in lineage.read(folder)["new.onnx"]


def test_the_lineage_of_every_shipped_weight_is_of_its_content() -> None:
    said = lineage.read(weights.FOLDER)
    assert {name: entry["sha256"] for name, entry in said.items()} == {
        name: lineage.sha256(weights.FOLDER / name) for name in weights.names()
    }


@pytest.mark.parametrize("name", RUNS)
def test_every_run_is_called_in_the_same_way(name: str) -> None:
    pytest.importorskip("onnx", reason="exporting needs onnx")
    module = import_module(f"involute.training.{RUNS[name][0]}")
    assert len(signature(module.main).parameters) == 1
