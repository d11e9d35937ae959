"""The Python code on the pages runs, and prints what they show.

The blocks of `python` of a page run in order, in one namespace and an empty folder. A block of `text` right after one is
its output: `…` stands for anything within a line. A block after `<!-- needs: PACKAGE -->` runs only where this package can
be imported.
"""

from __future__ import annotations

import ast
import contextlib
import importlib.util
import io
import re
import warnings
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import marbles
import pytest
from conftest import ROOT

DOCUMENT = ROOT / "docs" / "python.md"
README = ROOT / "crates" / "python" / "README.md"
LINK = re.compile(r"\]\(([^)\s]+)\)")


@dataclass(frozen=True)
class Block:
    """A fenced block of a page."""

    line: int  # of its fence, from 1
    language: str
    note: str  # the comment on the line before
    text: str
    follows: bool  # whether nothing but empty lines is between it and the block before


def blocks(page: str) -> list[Block]:
    """The fenced blocks of a page."""
    found: list[Block] = []
    fence, language, note, last, prose = 0, "", "", "", True
    inside: list[str] = []
    for number, line in enumerate(page.splitlines(), 1):
        if fence:
            if line == "```":
                found.append(Block(fence, language, note, "\n".join(inside) + "\n", not prose))
                fence, prose = 0, False
            else:
                inside.append(line)
        elif line.startswith("```"):
            comment = re.fullmatch(r"<!-- (.*) -->", last)
            fence, language, note, inside = number, line[3:], comment[1] if comment else "", []
        elif line:
            prose = True
        last = line
    assert not fence, f"the block of line {fence} has no end"
    return found


def shows(shown: str, printed: str) -> bool:
    """Whether a text is what a page shows, where `…` stands for anything within a line."""
    pattern = ".*".join(map(re.escape, shown.split("…")))
    return re.fullmatch(pattern, printed) is not None


def run(name: str, page: str) -> None:
    """Runs the code of a page. Raises AssertionError if it prints something else than is shown."""
    namespace: dict[str, Any] = {"__name__": "__main__"}
    printed: str | None = None
    for block in blocks(page):
        if block.language == "text" and block.follows and printed is not None:
            place = f"{name}:{block.line}"
            if not shows(block.text, printed):
                raise AssertionError(f"{place}: the page shows\n{block.text}and the code prints\n{printed}")
        printed = None
        package = block.note.removeprefix("needs: ") if block.note.startswith("needs: ") else None
        if block.language == "python" and (package is None or importlib.util.find_spec(package)):
            # Messages have the lines of the page.
            code = compile("\n" * block.line + block.text, name, "exec")
            with contextlib.redirect_stdout(io.StringIO()) as output:
                exec(code, namespace)
            printed = output.getvalue()


@pytest.mark.parametrize("path", [DOCUMENT, README], ids=lambda path: path.name)
def test_the_code_of_pages_runs(path: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    with warnings.catch_warnings():
        warnings.simplefilter("error", marbles.SceneWarning)
        run(path.name, path.read_text(encoding="utf-8"))


def test_the_first_program_is_short() -> None:
    for path in (DOCUMENT, README):
        first = next(block for block in blocks(path.read_text(encoding="utf-8")) if block.language == "python")
        assert len([line for line in first.text.splitlines() if line]) <= 10, path


@pytest.mark.parametrize("path", [DOCUMENT, README], ids=lambda path: path.name)
def test_links_lead_to_files_and_headings(path: Path) -> None:
    for link in LINK.findall(path.read_text(encoding="utf-8")):
        if "://" in link:
            continue
        file, _, heading = link.partition("#")
        target = path.parent / file if file else path
        assert target.exists(), link
        if heading:
            titles = re.findall(r"(?m)^#+ (.*)$", target.read_text(encoding="utf-8"))
            anchors = {re.sub(r"[^\w\- ]", "", title.lower()).replace(" ", "-") for title in titles}
            assert heading in anchors, link


def test_every_example_is_on_the_page() -> None:
    page = DOCUMENT.read_text(encoding="utf-8")
    for example in (ROOT / "crates" / "python" / "examples").glob("*.py"):
        assert f"(../crates/python/examples/{example.name})" in page, example


def test_every_public_name_and_option_is_on_the_page() -> None:
    page = DOCUMENT.read_text(encoding="utf-8")
    tree = ast.parse((ROOT / "crates" / "python" / "python" / "marbles" / "scene.py").read_text(encoding="utf-8"))
    [render] = [node for node in ast.walk(tree) if isinstance(node, ast.FunctionDef) and node.name == "render"]
    names = [argument.arg for argument in (*render.args.args[1:], *render.args.kwonlyargs)]
    names += [name for name in vars(marbles.Picture) if not name.startswith("_")]
    names += [name for name in vars(marbles.Scene) if not name.startswith("_")]
    missing = [name for name in names if not re.search(rf"\b{name}\b", page)]
    assert missing == []


PAGE = "Text.\n\n```python\nx = 1\nprint(x, 0.123)\n```\n\n```text\n1 0.1…\n```\n\nMore.\n\n```python\nassert x == 1\n```\n"


def test_a_page_that_is_wrong_is_found_out() -> None:
    run("page", PAGE)
    assert [(block.line, block.language, block.follows) for block in blocks(PAGE)] == [
        (3, "python", False),
        (8, "text", True),
        (14, "python", False),
    ]
    with pytest.raises(AssertionError, match="page:8: the page shows\n2 0.1…\nand the code prints\n1 0.123"):
        run("page", PAGE.replace("1 0.1…", "2 0.1…"))
    with pytest.raises(AssertionError):
        run("page", PAGE.replace("assert x == 1", "assert x == 2"))
    with pytest.raises(AssertionError, match="the block of line 14 has no end"):
        run("page", PAGE.removesuffix("```\n"))
    run("page", PAGE.replace("```python\nassert x == 1", "<!-- needs: no_such_package -->\n```python\nassert x == 2"))
