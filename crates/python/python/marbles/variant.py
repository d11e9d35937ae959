"""The base of all values that a scene file writes with a name, such as `Fov(40)`."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from types import MappingProxyType
from typing import Any, NoReturn, TypeAlias, TypeVar, Union

import numpy as np
from numpy.typing import NDArray

Number: TypeAlias = Union[float, "np.number[Any]"]
"""A real number."""

Vector: TypeAlias = Union[Sequence[Number], NDArray[Any]]
"""Numbers in a row: a tuple, a list or an array of one dimension."""

Color: TypeAlias = Union[Number, str, Vector]
"""A color: a number (gray), linear (red, green, blue), `"#rrggbb"`, or a name of CSS."""

Value: TypeAlias = Union[
    "Variant", Mapping[str, object], Sequence[object], NDArray[Any], np.generic, str, float, bool, Path, None
]
"""Anything that can stand in a scene. A value that is None is left out."""

_Any = TypeVar("_Any", bound="Variant")


class Variant:
    """A value with a name: `Variant("Fov", 40)` is `Fov(40)`, `Variant("Free", pan=15)` is `Free(pan: 15)`.

    The classes of this package, such as `marbles.Fov`, are variants with their own signatures. This class itself
    writes any other variant of a scene file. A variant cannot be changed. Fields that are None are left out. The scene
    that a variant is given to checks its numbers, and refuses them with `SceneError`.

    Args:
        name: The name in the scene file.
        values: Values without names, in order.
        fields: Values by name. A variant has either values or fields.

    Raises:
        TypeError: Both values and fields are given.
    """

    __slots__ = ("fields", "name", "values")

    name: str
    values: tuple[Value, ...]
    fields: Mapping[str, Value]

    def __init__(self, name: str, /, *values: Value, **fields: Value) -> None:
        written = {key: value for key, value in fields.items() if value is not None}
        if values and written:
            raise TypeError(f"{name}: expected either values or fields with names, found both")
        object.__setattr__(self, "name", name)
        object.__setattr__(self, "values", values)
        object.__setattr__(self, "fields", MappingProxyType(written))

    def __setattr__(self, name: str, value: object) -> NoReturn:
        raise AttributeError(f"{self.name} cannot be changed: make a new one")

    def __delattr__(self, name: str) -> NoReturn:
        raise AttributeError(f"{self.name} cannot be changed: make a new one")

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Variant):
            return NotImplemented
        return self.name == other.name and bool(_plain(self) == _plain(other))

    __hash__ = None  # type: ignore[assignment]

    def __reduce__(self) -> tuple[object, ...]:
        return _restore, (type(self), self.name, self.values, dict(self.fields))

    def __repr__(self) -> str:
        values = [repr(value) for value in self.values]
        fields = [f"{key}={value!r}" for key, value in self.fields.items()]
        return f"{self.name}({', '.join(values + fields)})"


def _restore(cls: type[_Any], name: str, values: tuple[Value, ...], fields: dict[str, Value]) -> _Any:
    """A variant of its parts, for copies and pickles."""
    variant = cls.__new__(cls)
    Variant.__init__(variant, name, *values, **fields)
    return variant


def _plain(value: object) -> object:
    """A value in which tuples, lists and arrays of the same items are the same."""
    if isinstance(value, Variant):
        return value.name, _plain(value.values), _plain(dict(value.fields))
    if isinstance(value, Mapping):
        return {key: _plain(item) for key, item in value.items() if item is not None}
    if isinstance(value, (np.ndarray, np.generic)):
        return _plain(value.tolist())
    if isinstance(value, (list, tuple)):
        return [_plain(item) for item in value]
    return value
