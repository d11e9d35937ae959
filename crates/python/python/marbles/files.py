"""Scenes written to files, with their tables beside them."""

from __future__ import annotations

import os
from pathlib import Path

from . import _native
from .draft import Draft
from .ron import quote, read_string


def save(draft: Draft, folder: Path, path: Path) -> None:
    """Writes a scene and its tables in memory; no file has its name before it is complete.

    Args:
        draft: The scene.
        folder: The folder in which the scene's own files are.
        path: The name of the scene file; tables become NAME_spheres.npy beside it.

    Raises:
        OSError: A file cannot be written.
    """
    text = _moved(draft, folder, path.parent)
    taken = {os.path.normpath(file) for _, file in _files(text, len(draft.tables)) if file is not None}
    for index, table in enumerate(draft.tables):
        stem, ending = os.path.splitext(table.file)
        name, number = f"{path.stem}_{stem}{ending}", 1
        while os.path.normpath(name) in taken:
            number += 1
            name = f"{path.stem}_{stem}_{number}{ending}"
        taken.add(name)
        text = _native.set_value(text, f"clouds[{index}].file", quote(name))
        _write(path.parent / name, table.contents)
    _write(path, text.encode())


def _moved(draft: Draft, old: Path, new: Path) -> str:
    """The text with the names of files as they are from another folder."""
    text = draft.text
    old, new = old.resolve(), new.resolve()
    if old == new:
        return text
    for place, file in _files(text, len(draft.tables)):
        if file is None or os.path.isabs(file):
            continue
        try:
            moved = os.path.relpath(old / file, new)
        except ValueError:  # on another drive
            moved = str(old / file)
        text = _native.set_value(text, place, quote(moved.replace(os.sep, "/")))
    return text


def _files(text: str, first: int) -> list[tuple[str, str | None]]:
    """The places of the names of files from a cloud on, and the names; None for one that is no string."""
    found = []
    index = first
    while _native.value_at(text, f"clouds[{index}]") is not None:
        for field in ("file", "topology"):
            place = f"clouds[{index}].{field}"
            name = _native.value_at(text, place)
            if name is not None:
                found.append((place, read_string(name)))
        index += 1
    return found


def _write(path: Path, contents: bytes) -> None:
    """Writes a file under another name, and gives it its own when it is complete."""
    number = 0
    while True:
        part = path.with_name(f".{path.name}.{os.getpid()}.{number}.part")
        try:
            file = open(part, "xb")
            break
        except FileExistsError:
            number += 1
    try:
        with file:
            file.write(contents)
        os.replace(part, path)
    except BaseException:
        part.unlink(missing_ok=True)
        raise
