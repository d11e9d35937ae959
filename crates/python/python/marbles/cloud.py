"""Spheres as arrays."""

from __future__ import annotations

import io
from collections.abc import Mapping
from types import MappingProxyType
from typing import Any, NoReturn, TypeAlias, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .numbers import check_finite, check_rows, colors, reals, refuse_first
from .variant import Color, Value

# Fields of a cloud that go with an array of spheres.
OPTIONS = (
    "color_scale",
    "colormap",
    "edges",
    "keep",
    "missing",
    "palette",
    "position",
    "range",
    "reversed",
    "right_handed",
    "rotate_degrees",
    "scale",
    "up",
)

# Values of `color` that say where colors come from.
SOURCES = ("Category", "Material", "Table", "Value")

Colors: TypeAlias = Union[Color, ArrayLike, None]


class Spheres:
    """Many spheres, given as arrays; a `Spheres` cannot be changed.

    Lists and arrays of any real type, byte order and strides are accepted, and copied once. Numbers of float32 are
    stored as such, others as float64.

    Args:
        center: The centers, (n, 3), in scene units: x right, y up, z forward.
        radius: One radius, or (n,); greater than 0, in scene units.
        color: A color for all (a number, a text, or three numbers), or (n, 3): linear red, green, blue of at least 0,
            or uint8 codes of sRGB. By default spheres have the color of the material. A color for all takes the place
            of the material's albedo. `"Category"` makes each number of `value` a category with its own color.
        value: (n,) numbers that a colormap shows; not together with an array of colors.
        material: The name of a material, which sets highlight, roughness and outline; matte white by default.
        cloud: Fields of a cloud: `colormap`, `color_scale`, `range`, `reversed`, `missing`, `palette`, and `scale`,
            `position`, `rotate_degrees`, `up`, `right_handed`, `keep`. With `missing`, values may be NaN.

    Raises:
        TypeError: An array of objects, texts, flags or complex numbers, or an unknown field.
        ValueError: A wrong shape, a number that is not finite, a radius that is not greater than 0, or a negative
            color. The message begins with the place: `spheres.radius[17]: …`.
    """

    __slots__ = ("_color", "_material", "_options", "_radius", "_records")

    _records: NDArray[Any]
    _radius: float | None
    _color: Color | None
    _material: str | None
    _options: Mapping[str, Value]

    def __init__(
        self,
        center: ArrayLike,
        radius: ArrayLike = 1.0,
        color: Colors = None,
        value: ArrayLike | None = None,
        material: str | None = None,
        **cloud: Value,
    ) -> None:
        for name in cloud:
            if name not in OPTIONS:
                raise TypeError(f"spheres.{name}: expected one of the fields {', '.join(OPTIONS)}, found {name!r}")
        if material is not None and not isinstance(material, str):
            raise TypeError(f"spheres.material: expected the name of a material, found {type(material).__name__}")
        centers = reals(center, "spheres.center", "(n, 3)")
        check_rows(centers, "spheres.center", 3, None)
        check_finite(centers, "spheres.center")
        count = len(centers)
        columns: list[tuple[str, NDArray[Any]]] = [("pos", centers)]
        radii = _radii(radius, count)
        if radii.ndim:
            columns.append(("radius", radii))
        one, many = _colors(color, count)
        if many is not None:
            columns.append(("color", many))
        if value is not None:
            if many is not None:
                raise ValueError("spheres.value: expected either `value` or an array of colors, found both")
            columns.append(("value", _values(value, count, cloud.get("missing"))))
            cloud = {"value": "value", **cloud}
        records = np.empty(count, [(name, array.dtype.newbyteorder("<"), array.shape[1:]) for name, array in columns])
        for name, array in columns:
            records[name] = array
        records.flags.writeable = False
        object.__setattr__(self, "_records", records)
        object.__setattr__(self, "_radius", None if radii.ndim else radii.item())
        object.__setattr__(self, "_color", one)
        object.__setattr__(self, "_material", material)
        object.__setattr__(self, "_options", MappingProxyType(cloud))

    def __setattr__(self, name: str, value: object) -> NoReturn:
        raise AttributeError("Spheres cannot be changed: make new ones")

    def __reduce__(self) -> tuple[object, ...]:
        return _restore, (self._records, self._radius, self._color, self._material, dict(self._options))

    def __len__(self) -> int:
        return len(self._records)

    def __repr__(self) -> str:
        names = ", ".join(self._records.dtype.names or ())
        material = "" if self._material is None else f", material={self._material!r}"
        return f"Spheres({len(self)} of {names}{material})"

    @property
    def material(self) -> str | None:
        """The name of the material, or None for matte white."""
        return self._material

    @property
    def color(self) -> Color | None:
        """The color of all spheres; None if an array, a colormap or the material has their colors."""
        return None if self._color in SOURCES else self._color

    @property
    def records(self) -> NDArray[Any]:
        """The records of the table, (n,), read-only: `pos`, and as given `radius`, `color`, `value`.

        `pos` and `color` are (n, 3), `radius` and `value` (n,). Their numbers are float32 where they were given as
        such, uint8 for codes of sRGB, and else float64.
        """
        return self._records

    def npy(self) -> bytes:
        """The contents of the NPY file: an array of records, little-endian."""
        header = io.BytesIO()
        np.lib.format.write_array_header_1_0(header, np.lib.format.header_data_from_array_1_0(self._records))
        return b"".join((header.getvalue(), self._records.view(np.uint8).data if len(self) else b""))

    def cloud(self, file: str) -> dict[str, Value]:
        """The item of `clouds` for these spheres, whose table has this name."""
        source = self._color if self._color in SOURCES else None
        start: dict[str, Value] = {"file": file, "material": self._material, "radius": self._radius, "color": source}
        return start | dict(self._options)


def _radii(given: ArrayLike, count: int) -> NDArray[Any]:
    """The radii, (count,), or one for all without a dimension."""
    radii = reals(given, "spheres.radius", "() or (n,)")
    if radii.ndim:
        check_rows(radii, "spheres.radius", None, count)
    else:
        radii = radii.astype(np.float64)
    check_finite(radii, "spheres.radius")
    if radii.size and not radii.min() > 0:
        refuse_first(~(radii > 0), radii, "spheres.radius", "a radius greater than 0")
    return radii


def _colors(given: Colors, count: int) -> tuple[Color | None, NDArray[Any] | None]:
    """A color for all spheres, or the colors of each."""
    if given is None:
        return None, None
    if isinstance(given, str):
        return given, None
    array = colors(given, "spheres.color")
    is_one = array.ndim == 0 or array.shape == (3,)
    if not is_one:
        check_rows(array, "spheres.color", 3, count)
    if array.dtype == np.uint8:
        return (None, array) if not is_one else (_hexadecimal(array), None)
    check_finite(array, "spheres.color")
    if array.size and not array.min() >= 0:
        refuse_first(~(array >= 0), array, "spheres.color", "a color of at least 0")
    return (array.tolist(), None) if is_one else (None, array)


def _hexadecimal(codes: NDArray[np.uint8]) -> str:
    """One color of sRGB codes as a text."""
    red, green, blue = np.broadcast_to(codes, 3).tolist()
    return f"#{red:02x}{green:02x}{blue:02x}"


def _values(given: ArrayLike, count: int, missing: Value) -> NDArray[Any]:
    values = reals(given, "spheres.value", "(n,)")
    check_rows(values, "spheres.value", None, count)
    if missing is None or missing == "Refuse":
        check_finite(values, "spheres.value")
    else:
        refuse_first(np.isinf(values), values, "spheres.value", "a finite number or NaN")
    return values


def _restore(*parts: object) -> Spheres:
    """Spheres of their parts, for copies and pickles."""
    spheres = Spheres.__new__(Spheres)
    for name, part in zip(("_records", "_radius", "_color", "_material", "_options"), parts):
        object.__setattr__(spheres, name, part)
    spheres._records.flags.writeable = False
    return spheres
