"""Every public name is described; arrays with their shape and type, and errors with their names."""

from __future__ import annotations

import ast
import inspect
import re
from collections.abc import Iterator
from pathlib import Path

import marbles
import pytest

FOLDER = Path(marbles.__file__).parent
MODULES = sorted([*FOLDER.glob("*.py"), FOLDER / "_native.pyi"])

# (n, 3), (n,), (height, width, 4) and so on.
SHAPE = re.compile(r"\((?:n|\d|height, width)(?:,|, \w+)*\)")
TYPE = re.compile(r"\b(?:float32|float64|uint8|uint32|bool)\b")

Documented = ast.Module | ast.ClassDef | ast.FunctionDef
Item = tuple[str, Documented, str | None]


def items(path: Path) -> Iterator[Item]:
    """The public parts of a module: their places, their code, and their docstrings."""
    module = ast.parse(path.read_text(encoding="utf-8"))
    yield path.name, module, ast.get_docstring(module)
    yield from members(module, path.name)


def members(parent: ast.Module | ast.ClassDef, place: str) -> Iterator[Item]:
    for node in parent.body:
        if isinstance(node, (ast.ClassDef, ast.FunctionDef)) and not node.name.startswith("_"):
            yield f"{place}: {node.name}", node, ast.get_docstring(node)
            if isinstance(node, ast.ClassDef):
                yield from members(node, f"{place}: {node.name}")


def attributes(path: Path) -> Iterator[tuple[str, str, str | None]]:
    """The public fields of classes that are described by a text below them: place, type, text."""
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if not isinstance(node, ast.ClassDef) or node.name.startswith("_"):
            continue
        for field, below in zip(node.body, [*node.body[1:], None]):
            if isinstance(field, ast.AnnAssign) and isinstance(field.target, ast.Name) and field.target.id[0] != "_":
                text = below.value if isinstance(below, ast.Expr) else None
                described = isinstance(text, ast.Constant) and isinstance(text.value, str)
                yield (
                    f"{path.name}: {node.name}.{field.target.id}",
                    ast.unparse(field.annotation),
                    text.value if isinstance(text, ast.Constant) and described else None,  # type: ignore[misc]
                )


def has_array(annotation: str) -> bool:
    return "NDArray" in annotation


@pytest.mark.parametrize("name", [name for name in marbles.__all__ if name != "__version__"])
def test_public_names_are_described(name: str) -> None:
    value = getattr(marbles, name)
    assert inspect.getdoc(value), name
    if not isinstance(value, type):
        return
    assert value.__doc__, f"{name} has only the text of its base"
    for own in (cls for cls in value.__mro__ if cls.__module__.startswith("marbles")):
        for member, content in vars(own).items():
            is_described = isinstance(content, property) or inspect.isfunction(content) or hasattr(content, "func")
            if not member.startswith("_") and is_described:
                assert inspect.getdoc(content), f"{name}.{member}"


@pytest.mark.parametrize("path", MODULES, ids=lambda path: path.name)
def test_all_code_without_underscore_is_described(path: Path) -> None:
    missing = [place for place, _, text in items(path) if not text and path.name != "__main__.py"]
    assert missing == []


def test_arrays_have_a_shape_and_a_type() -> None:
    checked = []
    for path in MODULES:
        if path.stem in ("numbers", "comparison"):
            continue  # of any shape
        for place, node, text in items(path):
            if isinstance(node, ast.FunctionDef) and node.returns and has_array(ast.unparse(node.returns)):
                checked.append(place)
                assert text and SHAPE.search(text) and TYPE.search(text), place
        if path.stem in ("camera", "_native"):
            for place, annotation, text in attributes(path):
                assert text, place
                if has_array(annotation):
                    checked.append(place)
                    assert SHAPE.search(text) and TYPE.search(text), place
    names = {place.split(": ", 1)[1] for place in checked}
    assert names >= {"Picture: light", "Picture: error", "Picture: bound", "Picture: to_srgb", "Scene: spheres_table"}
    assert names >= {"Camera.K", "Camera: project", "Spheres: records", "spheres"}
    assert SHAPE.search(marbles.Picture.__getitem__.__doc__ or "")


@pytest.mark.parametrize("path", MODULES, ids=lambda path: path.name)
def test_raised_errors_are_named(path: Path) -> None:
    """Those that a class or function raises by itself; what it calls may raise more."""
    for place, node, text in items(path):
        if isinstance(node, ast.Module):
            continue
        # A class is described with its constructor; its public methods are by themselves.
        bodies = [node] if isinstance(node, ast.FunctionDef) else [
            method for method in node.body if isinstance(method, ast.FunctionDef) and method.name == "__init__"
        ]  # fmt: skip
        for body in bodies:
            for part in ast.walk(body):
                if isinstance(part, ast.Raise) and isinstance(part.exc, ast.Call):
                    error = ast.unparse(part.exc.func).removeprefix("_native.")
                    is_named = error[0].isupper() and error not in (text or "")
                    assert not is_named, f"{place} raises {error}"


def test_fields_of_results_are_described() -> None:
    for path in (FOLDER / "camera.py", FOLDER / "comparison.py"):
        for place, _, text in attributes(path):
            assert text, place
