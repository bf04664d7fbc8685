"""A setting is declared once: its option, and its row in the manual, follow from that."""

from __future__ import annotations

import importlib.util
from dataclasses import fields
from pathlib import Path

import pytest
from involute.command import cli
from involute.command.arguments import parser
from involute.command.setting_options import settings_options
from involute.engine import InvoluteError, Settings
from involute.engine.settings import ABOUT, GROUPS

DOCS = Path(__file__).resolve().parents[2] / "docs"


def test_every_setting_is_declared_and_every_group_is_used():
    assert {field.name for field in fields(Settings)} - ABOUT.keys() == {"align"}  # measured
    assert {about.group for about in ABOUT.values()} == set(GROUPS)
    for about in ABOUT.values():
        assert about.tip[0].isupper() or about.tip[0].isdigit()
        assert not about.tip.endswith(".")


@pytest.mark.parametrize("name", ABOUT)
def test_what_is_not_the_default_comes_back_from_its_option(name):
    about, default = ABOUT[name], getattr(Settings(), name)
    other = {
        bool: lambda: not default,
        tuple: lambda: about.values[1:3],
        str: lambda: about.values[-1],
    }.get(about.kind, lambda: about.kind(about.high))()
    settings = Settings(**{name: other})
    words = settings_options(settings)
    assert len(words) == (1 if about.kind is bool else 2)
    options = parser().parse_args(["trace", "in.png", "-o", "out.svg", *words])
    assert cli.settings_of(options) == settings


def test_values_that_can_not_be_are_refused():
    for name, about in ABOUT.items():
        bad = ["nonsense", float("nan"), None]
        if about.kind in (int, float):
            bad += [about.low - 1, about.high + 1, True]
        for value in bad:
            with pytest.raises(InvoluteError, match=name):
                Settings(**{name: value})
    for value in ["nonsense", [1, 2], [(0, float("nan"))], 3]:
        with pytest.raises(InvoluteError, match="align"):
            Settings(align=value)


def test_help_names_every_option_and_ink(capsys):
    assert cli.main(["trace", "--help"]) == 0
    text = capsys.readouterr().out
    for value in ABOUT["ignore_inks"].values:
        assert value in text
    assert "--no-solids" in text


def test_the_manual_has_the_settings_as_they_are():
    spec = importlib.util.spec_from_file_location("manual_tables", DOCS / "manual_tables.py")
    tables = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(tables)
    for page in (DOCS / "manual").glob("*.md"):
        text = page.read_text("utf-8")
        assert tables.with_tables(text) == text, f"{page.name}: run python docs/manual_tables.py"
    assert "--pen-width" in (DOCS / "manual" / "settings.md").read_text("utf-8")
