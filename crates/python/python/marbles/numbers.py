"""Arrays of numbers from what users pass, checked as a whole."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray


def reals(given: object, path: str, shape: str) -> NDArray[Any]:
    """An array of float32 (if it is given as such) or float64, in native byte order; a view if that can be.

    Args:
        given: An array, or anything that NumPy makes an array of.
        path: The name of the array in messages.
        shape: The expected shape in messages.

    Raises:
        TypeError: No numbers, or complex numbers or flags.
    """
    array = _array(given, path, shape)
    kept = array.dtype.kind == "f" and array.dtype.itemsize == 4
    with np.errstate(over="ignore"):  # numbers that become infinite are refused with the others
        return array.astype(np.float32 if kept else np.float64, copy=False)


def colors(given: object, path: str) -> NDArray[Any]:
    """An array of colors: uint8 as it is, or else as `reals` does."""
    if isinstance(given, np.ndarray) and given.dtype == np.uint8:
        return given
    return reals(given, path, "(n, 3)")


def check_rows(array: NDArray[Any], path: str, columns: int | None, rows: int | None) -> None:
    """Refuses arrays of another shape than (rows,), or than (rows, columns). Raises ValueError."""
    wanted_rows = "n" if rows is None else str(rows)
    wanted = f"({wanted_rows},)" if columns is None else f"({wanted_rows}, {columns})"
    has_shape = array.ndim == (1 if columns is None else 2) and (columns is None or array.shape[1] == columns)
    if not has_shape or (rows is not None and len(array) != rows):
        raise ValueError(f"{path}: expected an array of the shape {wanted}, found {array.shape}")


def check_finite(array: NDArray[Any], path: str) -> None:
    """Refuses NaN and infinite numbers. Raises ValueError with the place of the first one."""
    # A sum is finite only if all of its numbers are: the slow way only tells where, or that the sum overflowed.
    with np.errstate(all="ignore"):
        is_clean = array.size == 0 or bool(np.isfinite(np.sum(array)))
    if not is_clean:
        refuse_first(~np.isfinite(array), array, path, "a finite number")


def refuse_first(bad: NDArray[np.bool_], array: NDArray[Any], path: str, expected: str) -> None:
    """Raises ValueError for the first number that is marked as bad, if any is."""
    flat = int(np.argmax(bad)) if bad.size else 0
    if bad.size and bad.flat[flat]:
        index = np.unravel_index(flat, bad.shape)
        place = f"[{', '.join(str(int(i)) for i in index)}]" if index else ""
        raise ValueError(f"{path}{place}: expected {expected}, found {array[index].item()}")


def _array(given: object, path: str, shape: str) -> NDArray[Any]:
    try:
        array = np.asarray(given)
    except (TypeError, ValueError, OverflowError, RecursionError) as error:
        message = f"{path}: expected numbers of the shape {shape}, found {type(given).__name__}: {error}"
        raise type(error)(message) if isinstance(error, (TypeError, ValueError)) else ValueError(message) from None
    if array.dtype.kind not in "iuf":
        raise TypeError(f"{path}: expected real numbers of the shape {shape}, found {_kind(array)}")
    return array


def _kind(array: NDArray[Any]) -> str:
    kinds = {"O": "objects", "c": "complex numbers", "b": "flags", "U": "texts", "S": "bytes"}
    return kinds.get(array.dtype.kind, str(array.dtype))
