"""The house keeps its order: who imports whom, one name per module, functions of one screen."""

from __future__ import annotations

import ast
from collections import defaultdict
from collections.abc import Iterator
from functools import cache
from pathlib import Path

import networkx as nx
from involute import package

ROOT = package.ROOT
# From the bottom to the top: a room imports from rooms before it, never after.
SHIPPED_ROOMS = ("engine", "command", "operators", "ui")
ROOMS = (*SHIPPED_ROOMS, "synthesis", "training", "benchmarks")


@cache
def trees() -> dict[str, ast.Module]:
    """Each module of each room, by its dotted name; `__init__` stands for its package."""
    found = {}
    for room in ROOMS:
        for file in sorted((ROOT / room).rglob("*.py")):
            parts = file.relative_to(ROOT).with_suffix("").parts
            name = ".".join(parts[:-1] if parts[-1] == "__init__" else parts)
            found[name] = ast.parse(file.read_text("utf-8"))
    return found


def imported(name: str, nodes: Iterator[ast.AST]) -> Iterator[tuple[str, str]]:
    """(module of ours, name taken from it) for each import among the nodes."""
    is_package = (ROOT / Path(*name.split(".")) / "__init__.py").exists()
    for node in nodes:
        if not isinstance(node, ast.ImportFrom):
            continue
        module = node.module or ""
        if node.level:
            above = name.split(".")
            above = above[: len(above) - node.level + is_package]
            module = ".".join([*above, *filter(None, [module])])
        module = module.removeprefix("involute.")
        for alias in node.names:
            deeper = f"{module}.{alias.name}"
            if deeper in trees():
                yield deeper, ""
            elif module in trees():
                yield module, alias.name


def on_loading(tree: ast.Module) -> Iterator[ast.AST]:
    """What runs when a module is imported: neither functions nor what only type checkers read."""
    waiting: list[ast.AST] = list(tree.body)
    while waiting:
        node = waiting.pop()
        if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef):
            continue
        if isinstance(node, ast.If) and ast.unparse(node.test) == "TYPE_CHECKING":
            continue
        yield node
        waiting += ast.iter_child_nodes(node)


def test_imports_run_one_way():
    """ui -> operators -> command -> engine; what is shipped needs nothing that is not."""
    rank = {room: number for number, room in enumerate(SHIPPED_ROOMS)}
    wrong = []
    for name, tree in trees().items():
        mine = rank.get(name.partition(".")[0])
        if mine is None:
            continue
        for other, _ in imported(name, ast.walk(tree)):
            if rank.get(other.partition(".")[0], len(rank)) > mine:
                wrong.append(f"{name} -> {other}")
    assert wrong == []


def test_what_is_not_shipped_has_its_order_too():
    """Synthesis needs of the engine its values and arrays, training nothing of the benchmarks."""
    allowed = {
        "synthesis": ("synthesis", "engine.values", "engine.errors", "engine.arrays"),
        "training": ("training", "synthesis", "engine"),
    }
    wrong = [
        f"{name} -> {other}"
        for name, tree in trees().items()
        for other, _ in imported(name, ast.walk(tree))
        if not f"{other}.".startswith(
            tuple(f"{room}." for room in allowed.get(name.partition(".")[0], ROOMS))
        )
    ]
    assert wrong == []


def test_no_circle_of_imports():
    graph = nx.DiGraph()
    for name, tree in trees().items():
        graph.add_edges_from((name, other) for other, _ in imported(name, on_loading(tree)))
    assert list(nx.simple_cycles(graph)) == []


def test_no_module_name_twice():
    homes = defaultdict(list)
    for name in trees():
        if not (ROOT / Path(*name.split(".")) / "__init__.py").exists():
            homes[name.rpartition(".")[2]].append(name)
    homes.pop("__main__", None)
    assert {base: names for base, names in homes.items() if len(names) > 1} == {}


def test_the_pure_core_knows_no_blender():
    """Plan purely, apply once: what a rerouting changes is worked out without Blender."""
    pure = [n for n in trees() if n.startswith("operators.grease_pencil.core")]
    names = ("card_layout", "picking", "following", "alike", "junction_table")
    pure += [f"operators.view.{name}" for name in names]
    for name in pure:
        for node in on_loading(trees()[name]):
            if isinstance(node, ast.Import | ast.ImportFrom):
                modules = [a.name for a in node.names] + [getattr(node, "module", "") or ""]
                assert not {"bpy", "gpu", "mathutils"} & {m.partition(".")[0] for m in modules}
        for other, _ in imported(name, on_loading(trees()[name])):
            assert other in pure or other.startswith("engine"), f"{name} -> {other}"


def test_ui_asks_no_verb_where_something_lies():
    """Of the verbs on junctions `ui` takes the classes that it shows as buttons, nothing else."""
    for name, tree in trees().items():
        if name.startswith("ui"):
            for other, taken in imported(name, ast.walk(tree)):
                if other.startswith("operators.junctions"):
                    assert taken.startswith("INVOLUTE_"), f"{name} takes {taken} of {other}"


def test_functions_fit_on_a_screen():
    long = set()
    for name, tree in trees().items():
        for node in ast.walk(tree):
            if isinstance(node, ast.FunctionDef) and node.end_lineno - node.lineno + 1 >= 60:
                long.add(f"{name}.{node.name}")
    assert long == set()


def test_what_operators_and_ui_show_to_others_is_documented():
    missing = []
    for name, tree in trees().items():
        if name.partition(".")[0] in ("operators", "ui"):
            assert ast.get_docstring(tree), name
            missing += [f"{name}.{thing}" for thing in _undocumented(tree)]
    assert missing == []


def _undocumented(node: ast.Module | ast.ClassDef) -> Iterator[str]:
    for child in node.body:
        if isinstance(child, ast.FunctionDef | ast.ClassDef):
            if not child.name.startswith("_") and not ast.get_docstring(child):
                yield child.name
            if isinstance(child, ast.ClassDef):
                yield from _undocumented(child)
