"""The differences of two pictures."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeAlias, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .numbers import reals
from .picture import Picture

Pixels: TypeAlias = Union[Picture, ArrayLike]


@dataclass(frozen=True)
class Comparison:
    """How much two pictures differ, in linear light."""

    max: float
    """The largest absolute difference of any channel."""
    mean: float
    """The mean of the absolute differences."""
    rms: float
    """The root of the mean of the squared differences."""
    beyond: int | None = None
    """The number of pixels that differ by more than both claim; None unless both are of `Picture`."""


def compare(a: Pixels, b: Pixels) -> Comparison:
    """Compares two pictures, or arrays of light of the same shape.

    Args:
        a, b: Pictures, or arrays or lists of real numbers of any shape; one of either kind goes, too.

    Raises:
        TypeError: An array of something other than real numbers.
        ValueError: The shapes differ, or there are no numbers.
    """
    first, second = _light(a, "a"), _light(b, "b")
    if first.shape != second.shape:
        raise ValueError(f"b: expected an array of the shape {first.shape}, found {second.shape}")
    if not first.size:
        raise ValueError("a: expected at least one number, found none")
    difference = np.abs(first - second)
    beyond = None
    if isinstance(a, Picture) and isinstance(b, Picture):
        beyond = int(np.count_nonzero(difference.max(axis=-1) > a.error + b.error))
    return Comparison(
        max=float(difference.max()),
        mean=float(difference.mean()),
        rms=float(np.sqrt(np.mean(np.square(difference)))),
        beyond=beyond,
    )


def _light(given: Pixels, name: str) -> NDArray[np.float64]:
    if isinstance(given, Picture):
        return given.light
    return reals(given, name, "of a picture").astype(np.float64, copy=False)
