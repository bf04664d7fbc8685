"""Settings as arguments of the command line, and as the tables of the manual's page about them."""

from __future__ import annotations

from collections.abc import Iterator

from ..engine.settings import ABOUT, DEFAULTS, GROUPS, About, Settings


def option(name: str) -> str:
    """The option of a setting, such as --no-solids for a switch that is on by default."""
    return f"--{'no-' if DEFAULTS[name] is True else ''}{name.replace('_', '-')}"


def settings_options(settings: Settings) -> list[str]:
    """The arguments of `involute trace` for settings that differ from the defaults."""
    words: list[str] = []
    for name in ABOUT:
        value = getattr(settings, name)
        if value == DEFAULTS[name]:
            continue
        words.append(option(name))
        if not isinstance(value, bool):
            words.append(",".join(value) if isinstance(value, tuple) else str(value))
    return words


def manual_tables() -> str:
    """The settings as Markdown: a heading and a table for each group of the sidebar."""
    return "\n\n".join("\n".join(_table(group)) for group in GROUPS)


def _table(group: str) -> Iterator[str]:
    yield f"## {group.capitalize()}\n"
    yield "| setting | command line | what it does |"
    yield "|---|---|---|"
    for name, about in ABOUT.items():
        if about.group == group:
            yield f"| {about.label} | `{option(name)}` | {'. '.join(_sentences(about))} |"


def _sentences(about: About) -> Iterator[str]:
    yield about.tip
    if about.kind is str:
        yield "; ".join(f"*{c.label}* (`{c.value}`): {_lower(c.tip)}" for c in about.choices)
    if about.kind is tuple:
        yield "Any of " + ", ".join(f"`{value}`" for value in about.values)
    if about.more:
        yield about.more


def _lower(text: str) -> str:
    """With a small first letter, unless the word is a name."""
    return text[0].lower() + text[1:]
