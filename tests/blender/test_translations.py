"""Every text that a user can see has one in each language, and none is left over."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
SOURCES = sorted([*ROOT.glob("ui/**/*.py"), *ROOT.glob("operators/**/*.py")])
LANGUAGES = ("german", "french", "japanese")
OUTSIDE = ("blend_file.py", "german.py", "french.py", "japanese.py")  # the command line; tables
SAME = {
    "",
    "1–2",
    "3",
    "4",
    "5+",
    "involute",
    "3D View",
    "Grease Pencil",
}  # of these there is no German
_BLENDERS = {"Name", "File Path", "Filepath used for importing the file"}  # it translates them
_SEEN = {"name", "description", "text", "heading"}
_TOLD = ("label", "message", "InvoluteError", "_color")


@pytest.fixture(params=LANGUAGES)
def table(part, request) -> dict[str, str]:
    return part(f"ui.language.{request.param}").TEXTS


def trees() -> Iterator[ast.Module]:
    for path in SOURCES:
        if path.name not in OUTSIDE:
            yield ast.parse(path.read_text("utf-8"))


def seen_in(tree: ast.Module) -> Iterator[str]:
    """The texts of one file that a user can see."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Call):
            name = ast.unparse(node.func).rpartition(".")[2]
            for keyword in node.keywords:
                if keyword.arg in _SEEN:
                    yield from texts(keyword.value)
                if keyword.arg == "items" and isinstance(keyword.value, ast.List):
                    for item in keyword.value.elts:
                        yield from (t for element in item.elts[1:3] for t in texts(element))
            if name in _TOLD:
                yield from (t for argument in node.args for t in texts(argument))
            if name == "report":
                yield from texts(node.args[1])
        if isinstance(node, ast.ClassDef):
            if node.name.startswith("INVOLUTE_OT"):
                yield ast.get_docstring(node)
            for line in node.body:
                if isinstance(line, ast.Assign) and line.targets[0].id in (
                    "bl_label",
                    "bl_description",
                ):
                    yield from texts(line.value)


def texts(node: ast.expr) -> Iterator[str]:
    if isinstance(node, ast.Constant) and isinstance(node.value, str):
        yield node.value
    elif isinstance(node, ast.IfExp):
        yield from [*texts(node.body), *texts(node.orelse)]
    elif isinstance(node, ast.BoolOp):
        yield from (t for value in node.values for t in texts(value))


# The modules of the engine whose sentences are seen in Blender, and those of them for programs.
ENGINE = (
    *("fidelity", "drawing", "grain", "vector_page", "scan/preparing", "scan/registration"),
    *(
        "scan/screentone",
        "scan/show_through",
        "scan/image_file",
        "scan/picture",
        "scan/polarity",
        "scan/movie",
    ),
    *("scan/psd", "centerline/backends", "routing/network", "sequence/frames"),
    *("formats/svg_lines", "centerline/given", "rough/asking"),
)
FOR_PROGRAMS = (
    "Lines that follow each other",
    "There is no stroke",
    "There is no junction",
    "Give the path of an image",
    "Can't trace",
    "{0} holds values outside 0 to 1",
    "The weights in {0} have no features",
    "The step between frames",
    "Can't read the frames",
    "Reading {0} needs the library",
)


def sentences_of_the_engine() -> Iterator[str]:
    """Whole sentences that stand in its code, what is filled in numbered."""
    for name in ENGINE:
        tree = ast.parse((ROOT / "engine" / f"{name}.py").read_text("utf-8"))
        inside = {id(n.value) for n in ast.walk(tree) if isinstance(n, ast.Expr)}  # docstrings
        filled = [n for n in ast.walk(tree) if isinstance(n, ast.JoinedStr)]
        inside |= {id(value) for node in filled for value in node.values}
        for node in ast.walk(tree):
            said = None if id(node) in inside else template(node)
            if said and said.endswith(".") and " " in said.strip():
                yield said


def template(node: ast.AST) -> str | None:
    if isinstance(node, ast.Constant) and isinstance(node.value, str):
        return node.value
    if not isinstance(node, ast.JoinedStr):
        return None
    places = iter(range(len(node.values)))
    return "".join(
        value.value if isinstance(value, ast.Constant) else f"{{{next(places)}}}"
        for value in node.values
    )


def of_settings(settings) -> set[str]:
    """The texts that the declarations of the settings bring into the sidebar."""
    seen = {*settings.GROUPS}
    for about in settings.ABOUT.values():
        seen |= {about.label, about.tip}
        seen |= {text for choice in about.choices for text in (choice.label, choice.tip)}
    return seen


def test_everything_that_is_seen_has_a_text(part, table):
    seen = {text for tree in trees() for text in seen_in(tree)} - SAME
    seen |= of_settings(part("engine.settings")) - {"Bézier"}
    assert len(seen) > 150
    assert sorted(seen - table.keys()) == []


def test_no_text_is_left_over(part, table):
    """Every English text of the table stands in the code; the other one has the same places."""
    written = set()
    for tree in trees():
        written |= {text for text in seen_in(tree) if text}
        written |= {
            node.value
            for node in ast.walk(tree)
            if isinstance(node, ast.Constant) and isinstance(node.value, str)
        }
    written |= of_settings(part("engine.settings"))
    assert sorted(table.keys() - written) == []
    for english, other in table.items():
        assert sorted(re.findall("{.*?}", english)) == sorted(re.findall("{.*?}", other))
        assert other.strip() == other != ""
        assert english.endswith(".") == other.endswith((".", "。"))
        assert english.count("\n") == other.count("\n")


def test_all_languages_say_the_same(part):
    """Under the codes that Blender has; one that it has not would never be seen."""
    codes = part("ui.language.translations")._LANGUAGES
    assert set(codes) == {"de_DE", "fr_FR", "ja_JP"}
    for table in codes.values():
        assert table.keys() == part("ui.language.german").TEXTS.keys()


def test_classes_show_only_known_texts(bpy, part, table):
    """What Blender itself knows of our operators, settings and panels."""
    ours = part("operators")._classes()
    for name in part("ui")._WITH_CLASSES:
        ours += part(f"ui.{name}").CLASSES
    missing = set()
    for cls in ours:
        own = {n for base in cls.__mro__ for n in getattr(base, "__annotations__", {})}
        for prop in cls.bl_rna.properties:
            if prop.identifier in own and not prop.is_hidden:
                missing |= {prop.name, prop.description}
                if prop.type == "ENUM":
                    missing |= {t for i in prop.enum_items for t in (i.name, i.description)}
    missing -= {*table, *SAME, "Bézier", *_BLENDERS}
    assert sorted(missing) == []


def test_texts_are_filled(bpy, part):
    """Blender's Python module speaks English only: German was looked at in a window."""
    label, message = part("operators.language").label, part("operators.language").message
    assert label("{done} of {count} frames", done=1, count=3) == "1 of 3 frames"
    assert message(part("engine").InvoluteError("a {brace}")) == "a {brace}"


def test_sentences_of_the_engine_have_a_text(part):
    known = set(part("operators.engine_sentences").SENTENCES)
    said = {s for s in sentences_of_the_engine() if not s.startswith(FOR_PROGRAMS)}
    assert len(said) > 30
    assert sorted(said - known) == []
    assert sorted(s for s in known if s.endswith(".") and s not in said) == []
    for language in LANGUAGES:
        assert sorted(known - part(f"ui.language.{language}").TEXTS.keys()) == []


def test_a_filled_sentence_is_recognised(bpy, part, monkeypatch):
    """With its names and numbers, the phrases in it, and the options by the sidebar's names."""
    sentences = part("operators.engine_sentences")
    german = part("ui.language.german").TEXTS
    for name in ("pgettext_rpt", "pgettext_iface"):
        monkeypatch.setattr(sentences, name, lambda text: german.get(text, text))
    told = sentences.in_their_words
    assert told("There is no file /a, b/it.png; check the path.") == (
        "Es gibt keine Datei /a, b/it.png; den Pfad prüfen."
    )
    assert told(
        "Left out as no part of the drawing: dark borders of the scan, 3 punched holes."
    ) == ("Als nicht zur Zeichnung gehörig weggelassen: dunkle Ränder des Scans, 3 Lochungen.")
    fidelity = part("engine.fidelity")
    found = fidelity.Fidelity(0.5, 0.0, (), ())
    (said,) = (told(sentence) for sentence in fidelity.warnings(found, False))
    assert said.startswith("50% der Tusche sind nicht in der Zeichnung; “Liniensuche: ")
    assert "--" not in said
    assert told("Something that nobody knows.") == "Something that nobody knows."
