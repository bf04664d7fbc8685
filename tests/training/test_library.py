"""One split of the drawings for every training, every held-out page and every limit."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

pytest.importorskip("torch", reason="training needs torch")

from involute.synthesis import held_out_pages
from involute.synthesis.composed_pages import SOURCES
from involute.synthesis.composed_pages import Library as RoutingLibrary
from involute.synthesis.library import family, is_held_out, read_sets
from involute.synthesis.line_art import SET_WEIGHTS
from involute.synthesis.line_art import Library as CenterlineLibrary
from involute.training.routing import geometric_fit, traced
from involute.training.undrawn import train_undrawn

NAMES = ["openclipart", "streamline", "quickdraw_raw"]
WORDS = ("abbot", "bear", "cedar", "dune", "elk", "fig", "gate", "hat", "ice", "jar")
TITLES = [f"{word}_{kind}" for word in WORDS for kind in ("xyz", "uvw", "rst", "opq", "lmn")]


def write_set(folder: Path, name: str, titles: list[str]) -> None:
    """A set whose drawing t is one stroke that starts at (1 + its number, number of the set)."""
    mark = 1 + np.arange(len(titles))
    at = np.full(len(titles), 1 + sum(map(ord, name)) % 900)
    points = np.stack([np.stack([mark, at], 1), np.stack([mark, at + 50], 1)], 1).reshape(-1, 2)
    np.savez(
        folder / f"{name}.npz",
        points=(points * 32).astype(np.uint16),
        scale=1 / 32,
        stroke_offsets=2 * np.arange(len(titles) + 1),
        drawing_offsets=np.arange(len(titles) + 1),
    )
    (folder / f"{name}.json").write_text(json.dumps({"names": titles}))


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    for name in NAMES:
        write_set(tmp_path, name, TITLES)
    return tmp_path


def seen(folder: Path, held_out: bool) -> dict[str, set[tuple[float, float]]]:
    """The drawings that each consumer draws from on one side, by where their stroke starts."""
    rng = np.random.default_rng(0)
    centerline = CenterlineLibrary.load(folder)
    routing = RoutingLibrary.load(folder, held_out)
    by_hand = [
        strokes[0][0]
        for drawn in read_sets(folder, geometric_fit.SETS).values()
        for side, strokes in geometric_fit.drawings(drawn, 10**6)
        if side == held_out
    ]
    starts = {
        "centerline": [centerline.pick(rng, held_out)[0][0] for _ in range(4000)],
        "routing": [
            (routing.pick(rng, name)[0][0] + 0.5) * 1024
            for name in routing.sources
            for _ in range(1500)
        ],
        "geometric": by_hand,
    }
    return {who: {tuple(np.round(p, 1).tolist()) for p in found} for who, found in starts.items()}


def test_no_drawing_is_on_both_sides_of_any_two_consumers(folder: Path) -> None:
    learnt, held = seen(folder, False), seen(folder, True)
    assert all(learnt.values())
    assert all(held.values())
    for known in learnt.values():
        for judged in held.values():
            assert not known & judged
    everything = {who: learnt[who] | held[who] for who in learnt}
    assert {len(found) for found in everything.values()} == {len(NAMES) * len(TITLES)}


def test_all_other_pages_come_out_of_these_libraries() -> None:
    assert held_out_pages.Library is RoutingLibrary
    assert train_undrawn.Library is RoutingLibrary
    assert traced.Library is RoutingLibrary
    assert set(SOURCES) == set(SET_WEIGHTS)


def test_an_added_set_and_another_order_move_no_drawing(folder: Path) -> None:
    def sides() -> dict[tuple[str, str], bool]:
        sets = read_sets(folder, SOURCES)
        return {
            (name, title): bool(side)
            for name in NAMES
            for title, side in zip(sets[name].titles, sets[name].held_out, strict=True)
        }

    before = sides()
    write_set(folder, "arcticons", TITLES)
    write_set(folder, "openclipart", [*reversed(TITLES), "a new one"])
    after = sides()
    assert all(after[key] == side for key, side in before.items())
    assert 0.03 < np.mean(list(before.values())) < 0.2


def test_a_copy_by_another_name_is_trained_on_like_the_drawing(tmp_path: Path) -> None:
    # Generators make some drawings again and again: "Arch.arch02:27" and "Arch.arch02:147".
    write_set(tmp_path, "tangles", [f"Arch.arch:{k}" for k in range(60)])
    with np.load(tmp_path / "tangles.npz") as packed:
        same = dict(packed) | {"points": np.tile(packed["points"][:2], (60, 1))}
    np.savez(tmp_path / "tangles.npz", **same)
    assert not read_sets(tmp_path, ["tangles"])["tangles"].held_out.any()


@pytest.mark.parametrize(
    ("one", "other"),
    [
        ("people/smilies/smiley107.svg", "people/smilies/smiley2.svg"),
        ("streamline-emojis:robot-face-1", "streamline-emojis:robot-face-2"),
        ("lucide:file-clock", "lucide:file-x"),
        ("E341 gardener woman", "E340 gardener man"),
        ("1F468-200D-1F9B0 man: red hair", "1F468-200D-1F9B1 man: curly hair"),
    ],
)
def test_variants_of_a_drawing_are_one_family(one: str, other: str) -> None:
    assert family(one) == family(other)


def test_numbers_of_a_generator_and_signs_are_drawings_of_their_own() -> None:
    assert family("Mount.mountain:3") != family("Mount.mountain:4")
    assert family("悠") != family("爺")
    sides = [is_held_out("tangles", f"Mount.mountain:{k}") for k in range(1200)]
    assert np.mean(sides) == pytest.approx(1 / 12, abs=0.03)


def test_both_sets_of_one_collection_agree() -> None:
    for title in TITLES:
        assert is_held_out("quickdraw_raw", title) == is_held_out("quickdraw_simplified", title)


def test_without_drawings_the_folder_is_named(tmp_path: Path) -> None:
    with pytest.raises(FileNotFoundError, match="No drawings"):
        read_sets(tmp_path, SOURCES)
