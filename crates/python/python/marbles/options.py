"""Options of a rendering, as the compiled half takes them."""

from __future__ import annotations

import operator
from collections.abc import Iterable, Sequence
from typing import Literal, TypeAlias, TypedDict, get_args

Depth: TypeAlias = Literal["axis", "ray"]
Axes: TypeAlias = Literal["world", "camera-opencv", "camera-opengl"]
Pair: TypeAlias = tuple[int, int]


class Options(TypedDict):
    """The keywords of `_native.Scene.start`."""

    tolerance: float | None
    samples: int | None
    alpha: bool
    channels: list[str]
    depth: str
    axes: str
    size: Pair | None
    region: tuple[int, int, int, int] | None
    per_light: bool
    threads: int | None
    progress: bool


DEFAULT_TOLERANCE = 1e-3


def checked(
    tolerance: float | None,
    *,
    samples: int | None,
    channels: Iterable[str] | str,
    per_light: bool,
    alpha: bool,
    depth: str,
    axes: str,
    size: Sequence[int] | None,
    region: Sequence[int] | None,
    threads: int | None,
    progress: bool,
) -> Options:
    """The options as keywords. Raises TypeError and ValueError with the name of the option."""
    if tolerance is not None and samples is not None:
        raise ValueError(f"samples: expected no `tolerance` beside it, found {tolerance!r}")
    if tolerance is None:
        tolerance = DEFAULT_TOLERANCE
    names = channels.split(",") if isinstance(channels, str) else list(channels)
    if not all(isinstance(name, str) for name in names):
        raise TypeError("channels: expected names such as 'depth', found something else")
    for name, text, known in (("depth", depth, get_args(Depth)), ("axes", axes, get_args(Axes))):
        if not isinstance(text, str):
            raise TypeError(f"{name}: expected a text, found {type(text).__name__}")
        if text not in known:
            raise ValueError(f"{name}: expected one of {', '.join(known)}, found {text!r}")
    width_height = whole_numbers(size, "size", ("width", "height"), 1)
    corner = whole_numbers(region, "region", ("column", "row", "width", "height"), 0)
    return Options(
        tolerance=_real(tolerance, "tolerance") if samples is None else None,
        samples=None if samples is None else whole(samples, "samples", 1, 2**16),
        alpha=bool(alpha),
        channels=[name.strip() for name in names if name.strip()],
        depth=depth,
        axes=axes,
        size=None if width_height is None else (width_height[0], width_height[1]),
        region=None if corner is None else (corner[0], corner[1], corner[2], corner[3]),
        per_light=bool(per_light),
        threads=None if threads is None else whole(threads, "threads", 1, 2**16),
        progress=bool(progress),
    )


def whole(given: object, name: str, least: int, most: int) -> int:
    """A whole number in a range, ends included. Raises TypeError or ValueError with its name."""
    try:
        number = operator.index(given)  # type: ignore[arg-type]
    except TypeError:
        raise TypeError(f"{name}: expected a whole number, found {type(given).__name__}") from None
    if isinstance(given, bool) or not least <= number <= most:
        expected = f"a whole number from {least} to {most}" if least < most else str(least)
        raise ValueError(f"{name}: expected {expected}, found {given}")
    return number


def whole_numbers(given: Sequence[int] | None, name: str, parts: Sequence[str], least: int) -> list[int] | None:
    """Several whole numbers, each with the name of its part. Raises TypeError or ValueError."""
    if given is None:
        return None
    expected = f"({', '.join(parts)})"
    try:
        numbers = list(given)
    except TypeError:
        raise TypeError(f"{name}: expected {expected}, found {type(given).__name__}") from None
    if len(numbers) != len(parts):
        raise ValueError(f"{name}: expected {expected}, found {len(numbers)} numbers")
    return [whole(number, f"{name}[{index}]", least, 65536) for index, number in enumerate(numbers)]


def _real(given: object, name: str) -> float:
    if isinstance(given, (str, bytes)):
        raise TypeError(f"{name}: expected a number, found {given!r}")
    try:
        return float(given)  # type: ignore[arg-type]
    except TypeError:
        raise TypeError(f"{name}: expected a number, found {type(given).__name__}") from None
    except OverflowError:
        raise ValueError(f"{name}: expected a number, found one that is too large") from None
