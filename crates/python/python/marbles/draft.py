"""The text of a scene, with arrays of spheres as tables in memory, and the changes to it."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from typing import cast

from . import _native
from .cloud import Spheres
from .ron import read_string, write, write_scene
from .variant import Value

# Stands for a value that is taken out of a text.
_TAKEN_OUT = "TakenOutOfTheScene"


@dataclass(frozen=True)
class Table:
    """Spheres in memory: an item of `clouds`."""

    spheres: Spheres
    path: str  # in Python: "spheres", or "spheres[3]" in a list
    file: str
    contents: bytes
    material: str | None  # the name of its own material, which has its only color


@dataclass(frozen=True)
class Draft:
    """A scene as a text in RON and tables in memory, which are the first clouds."""

    text: str
    tables: tuple[Table, ...] = ()
    # The places in Python of the spheres of the text; empty if they are the same.
    places: tuple[int, ...] = ()

    def rename(self, path: str) -> str:
        """The path in Python of a value at a path of the text."""
        match = re.match(r"(clouds|spheres)\[(\d+)\]", path)
        if match:
            index, rest = int(match[2]), path[match.end() :]
            if match[1] == "spheres":
                return f"spheres[{self.places[index] if self.places else index}]{rest}"
            if index < len(self.tables):
                return self.tables[index].path + rest
            return f"clouds[{index - len(self.tables)}]{rest}"
        for table in self.tables:
            if table.material is not None and f"{path}.".startswith(f"materials.{table.material}."):
                return f"{table.path}.color"
        return re.sub(r'^materials\.(?:"([^"]*)"|([^.\[]+))', r'materials["\1\2"]', path)

    def files(self) -> dict[str, bytes]:
        """The contents of the tables, by the names of their files."""
        return {table.file: table.contents for table in self.tables}

    def paths(self) -> dict[str, str]:
        """The paths of the tables in Python, by the names of their files."""
        return {table.file: table.path for table in self.tables}


def new(fields: Mapping[str, object]) -> Draft:
    """A scene of the fields of a scene file. Raises TypeError, ValueError and SceneError."""
    fields = {name: value for name, value in fields.items() if not _is_empty(name, value)}
    filled: dict[str, object] = {name: fields.pop(name) for name in ("spheres", "clouds") if name in fields}
    # They get lines of their own before they are filled.
    lines = [name for name in ("spheres", "clouds") if name in filled or _has_tables(filled.get("spheres"))]
    text = write_scene(cast(Mapping[str, Value], fields | dict.fromkeys(lines, ())))
    return replaced(Draft(text), filled)


def replaced(draft: Draft, fields: Mapping[str, object]) -> Draft:
    """The scene with other values in some fields; those that are None are left out.

    New `spheres` take the place of all tables in memory, and new `clouds` that of all others.

    Raises:
        TypeError, ValueError: A value that no scene file can have.
        SceneError: The text cannot take the value.
    """
    text = draft.text
    given, others = dict(fields), _clouds(draft)
    for name, value in given.items():
        if name in ("spheres", "clouds"):
            continue
        text = _without(text, name) if value is None else _with(text, name, write(cast(Value, value), name))
    for table in draft.tables:
        if table.material is not None:
            text = _without(text, f"materials.{table.material}")
    places, sources = draft.places, [(table.spheres, table.path) for table in draft.tables]
    if "spheres" in given:
        items, places, sources = _split(given["spheres"])
        if items or _native.value_at(text, "spheres") is not None:
            text = _with(text, "spheres", _list(items))
    if "clouds" in given:
        others = _items(given["clouds"])
    taken = {read_string(file) for file in (_native.value_at(item, "file") for item in others) if file}
    tables: list[Table] = []
    for spheres, path in sources:
        text, table = _add_material(text, spheres, path, _free_file(taken))
        taken.add(table.file)
        tables.append(table)
    clouds = [_cloud(table) for table in tables] + others
    if clouds or _native.value_at(text, "clouds") is not None:
        text = _with(text, "clouds", _list(clouds))
    return Draft(text, tuple(tables), places)


def _is_empty(name: str, value: object) -> bool:
    is_list = name in ("lights", "spheres", "clouds") and not isinstance(value, (Spheres, str, Mapping))
    return value is None or (is_list and isinstance(value, Sequence) and len(value) == 0)


def _has_tables(spheres: object) -> bool:
    if isinstance(spheres, Sequence) and not isinstance(spheres, str):
        return any(isinstance(item, Spheres) for item in spheres)
    return isinstance(spheres, Spheres)


def _list(items: Sequence[str]) -> str:
    """Items as a list: in a line of their own each, if there are several."""
    return f"[{', '.join(items)}]" if len(items) < 2 else "[\n        " + ",\n        ".join(items) + ",\n    ]"


def _items(value: object) -> list[str]:
    """The items of `clouds` as RON."""
    if value is None:
        return []
    if isinstance(value, (str, Mapping)) or not isinstance(value, Sequence):
        raise TypeError(f"clouds: expected a list, found {type(value).__name__}")
    return [write(cast(Value, item), "", f"clouds[{index}]") for index, item in enumerate(value)]


def _clouds(draft: Draft) -> list[str]:
    """The clouds of a text that are no tables in memory."""
    clouds = []
    index = len(draft.tables)
    while (item := _native.value_at(draft.text, f"clouds[{index}]")) is not None:
        clouds.append(item)
        index += 1
    return clouds


def _split(given: object) -> tuple[list[str], tuple[int, ...], list[tuple[Spheres, str]]]:
    """Single spheres as RON and their places in Python, and spheres in arrays with their paths."""
    if isinstance(given, Spheres):
        return [], (), [(given, "spheres")]
    if given is None:
        return [], (), []
    if isinstance(given, (str, Mapping)) or not isinstance(given, Sequence):
        raise TypeError(f"spheres: expected `Spheres`, or a list of dicts and `Spheres`, found {type(given).__name__}")
    arrays, items, places = [], [], []
    for place, item in enumerate(given):
        if isinstance(item, Spheres):
            arrays.append((item, f"spheres[{place}]"))
        else:
            items.append(write(cast(Value, item), "", f"spheres[{place}]"))
            places.append(place)
    return items, tuple(places) if arrays else (), arrays


def _free_file(taken: set[str | None]) -> str:
    number = 1
    while (file := "spheres.npy" if number == 1 else f"spheres_{number}.npy") in taken:
        number += 1
    return file


def _cloud(table: Table) -> str:
    fields = table.spheres.cloud(table.file)
    if table.material is not None:
        fields["material"] = table.material
    return write(fields, "", table.path)


def _add_material(text: str, spheres: Spheres, path: str, file: str) -> tuple[str, Table]:
    """The text with the material that spheres of one color have of their own, and their table."""
    make = partial(Table, spheres, path, file, spheres.npy())
    if spheres.color is None:
        return text, make(None)
    base = "()"
    if spheres.material is not None:
        if not re.fullmatch(r"[^\"\\]+", spheres.material):
            raise ValueError(f"{path}.material: expected a name without quotation marks, found {spheres.material!r}")
        found = _native.value_at(text, f'materials."{spheres.material}"')
        if found is None:
            return text, make(None)  # the scene has no such material, and will say so
        base = found
    if _native.value_at(text, "materials") is None:
        text = _with(text, "materials", "{}")
    number, name = 1, "spheres"
    while _native.value_at(text, f"materials.{name}") is not None:
        number, name = number + 1, f"spheres_{number + 1}"
    text = _native.set_value(text, f"materials.{name}", base)
    albedo = write(spheres.color, "albedo", f"{path}.color")
    text = _native.set_value(text, f"materials.{name}.albedo", albedo)
    return text, make(name)


def _with(text: str, field: str, value: str) -> str:
    """The text with a value in a field of the scene; a new field gets its own line."""
    is_new = _native.value_at(text, field) is None
    text = _native.set_value(text, field, value)
    return re.sub(rf"(?<=,)[^\S\n]*(?={field}: {re.escape(value)}\s*\)\s*$)", "\n    ", text) if is_new else text


def _without(text: str, path: str) -> str:
    """The text without the field or the name at a path."""
    if _native.value_at(text, path) is None:
        return text
    marked = _native.set_value(text, path, _TAKEN_OUT)
    field = rf'[\w"]+\s*:\s*{_TAKEN_OUT}'
    # With its line if it has one of its own, or with the comma before it if it is the last one.
    for around in (rf"(?m)^[^\S\n]*{field}\s*,?[^\S\n]*\n", rf",\s*{field}(?=\s*[)}}])", rf"{field}\s*,?[^\S\n]*"):
        rest, count = re.subn(around, "", marked)
        if count:
            break
    if count != 1:
        raise ValueError(f"{path}: expected a field that can be left out, found a comment between its name and value")
    return rest
