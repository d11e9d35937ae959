"""Values of clouds: columns of tables, conditions on rows, and the ways from numbers to radii and colors."""

from __future__ import annotations

from .variant import Number, Variant


class Power(Variant):
    """Radii from a power of a column's numbers.

    `Power(0.5)` is a `radius_law`: the radius is the square root of the number. `Power(column="m", factor=2,
    exponent=0.5, offset=1)` stands in place of a column of radii: offset + factor · number ^ exponent.

    Args:
        exponent: The exponent, greater than 0 for a `radius_law`; 1 by default for a column.
        column: The name of a column, or its number from 1.
        factor, offset: Numbers; 1 and 0 by default. Only with `column`.

    Raises:
        TypeError: `factor` or `offset` without `column`, or neither `exponent` nor `column`.
    """

    __slots__ = ()

    def __init__(
        self,
        exponent: Number | None = None,
        *,
        column: str | int | None = None,
        factor: Number | None = None,
        offset: Number | None = None,
    ) -> None:
        if column is not None:
            super().__init__("Power", column=column, factor=factor, exponent=exponent, offset=offset)
        elif exponent is None or factor is not None or offset is not None:
            raise TypeError("Power: expected an exponent, or a column with `factor`, `exponent` and `offset`")
        else:
            super().__init__("Power", exponent)


class Exponential(Variant):
    """A `radius_law` for magnitudes: the radius is 10 ^ (exponent · number).

    Args:
        exponent: A number greater than 0.
    """

    __slots__ = ()

    def __init__(self, exponent: Number) -> None:
        super().__init__("Exponential", exponent)


class Constant(Variant):
    """A number in place of a column: `columns=dict(z=Constant(0))`.

    Args:
        number: The number of all rows.
    """

    __slots__ = ()

    def __init__(self, number: Number) -> None:
        super().__init__("Constant", number)


class Length(Variant):
    """A `value`: the length of a vector whose components are three columns.

    Args:
        x, y, z: Names of columns, their numbers from 1, or constants (floats).
    """

    __slots__ = ()

    def __init__(self, x: str | float | Constant, y: str | float | Constant, z: str | float | Constant) -> None:
        super().__init__("Length", x, y, z)


class Percentile(Variant):
    """A `range` of colors between two percentiles of the numbers.

    Args:
        low, high: Percentages from 0 to 100, the low one less than the high one.
    """

    __slots__ = ()

    def __init__(self, low: Number, high: Number) -> None:
        super().__init__("Percentile", low, high)


class Diverging(Variant):
    """A `color_scale` in which a number has the middle color, and both sides the same scale.

    Args:
        middle: The number with the middle color.
    """

    __slots__ = ()

    def __init__(self, middle: Number) -> None:
        super().__init__("Diverging", middle)


class Is(Variant):
    """A condition of `keep`: the field is equal to a number or a text, as in `keep=[("type", Is(2))]`.

    Args:
        wanted: The number or the text.
    """

    __slots__ = ()

    def __init__(self, wanted: Number | str) -> None:
        super().__init__("Is", wanted)


class Between(Variant):
    """A condition of `keep`: the number is in a range, ends included.

    Args:
        low, high: The ends of the range.
    """

    __slots__ = ()

    def __init__(self, low: Number, high: Number) -> None:
        super().__init__("Between", low, high)


class Every(Variant):
    """A condition of `keep`: the number is a multiple of another one.

    Args:
        step: The other number, greater than 0.
    """

    __slots__ = ()

    def __init__(self, step: Number) -> None:
        super().__init__("Every", step)
