"""Errors and warnings of scenes."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path

from . import _native
from ._native import SceneError


class SceneWarning(UserWarning):
    """An oversight in a scene, such as a light without effect. The scene can be rendered."""


def warn(messages: Iterable[str], stacklevel: int) -> None:
    """Issues warnings for the caller that is `stacklevel` calls above this function's."""
    for message in messages:
        warnings.warn(message, SceneWarning, stacklevel=stacklevel + 1)


@contextmanager
def python_paths(rename: Callable[[str], str], tables: dict[str, str]) -> Iterator[None]:
    """Tells the faults of a scene made in Python by the names that values have there.

    Args:
        rename: From the path of a value in the file to its path in Python.
        tables: The paths in Python of tables in memory, by the names of their files.
    """
    try:
        yield
    except SceneError as error:
        raise _renamed(error, rename, tables) from None


def _renamed(
    error: _native.SceneError, rename: Callable[[str], str], tables: dict[str, str]
) -> _native.SceneError:
    table = tables.get(Path(error.file).name) if error.file else None
    places = [table or rename(fault.path) for fault in error.faults]
    told = [f"{place}: {fault.message}" if place else fault.message for place, fault in zip(places, error.faults)]
    message = "\n".join(told) or (f"{table}: {error}" if table else str(error))
    renamed = SceneError(message)
    renamed.faults = error.faults
    renamed.file = error.file
    renamed.path = table or rename(error.path)
    renamed.line = renamed.column = None
    return renamed
