"""Lights, the sky, and the values of materials that have a name."""

from __future__ import annotations

from typing import Literal

from .variant import Color, Number, Variant, Vector


class Directional(Variant):
    """A light so far away that the direction toward it is the same everywhere.

    Args:
        toward: A vector of any length toward the light.
        intensity: The color of a white surface that faces the light, in linear light; 1 by default.
        diameter: The angle in degrees that the disc of the light has across, at least 0 and less than 180; that of the
            sun is 0.53. With 0, the default, shadows are hard.
        name: A unique name, which keys of an animation use.
        attached: `"Camera"` for a light that moves with the camera; `toward` is then in the axes of the camera: x
            right, y up, z forward.
    """

    __slots__ = ()

    def __init__(
        self,
        toward: Vector,
        intensity: Color | None = None,
        *,
        diameter: Number | None = None,
        name: str | None = None,
        attached: Literal["Camera"] | None = None,
    ) -> None:
        super().__init__(
            "Directional", name=name, toward=toward, attached=attached, intensity=intensity, diameter=diameter
        )


class Point(Variant):
    """A light at a position; with a `direction`, an LED.

    Args:
        position: The position of the light, in scene units.
        intensity: The color of a white surface that faces the light at the distance `reference`, in linear light; 1
            by default.
        falloff: `"InverseSquare"` (the default): at the distance r the intensity is multiplied by
            (reference / r)²; `"None"`: it is the same at any distance.
        reference: A distance in scene units, greater than 0; by default the median distance to the surfaces of the
            spheres in the first frame.
        direction: A vector of any length toward what the light faces. At an angle θ to it, the light is multiplied
            by (cos θ)^mu; from 90 degrees on there is none. Without it the light is the same in all directions.
        mu: The power, at least 0; 1 by default. Only with `direction`.
        name: A unique name, which keys of an animation use.
        attached: `"Camera"` for a light that moves with the camera; `position` and `direction` are then in the axes
            of the camera: x right, y up, z forward.
    """

    __slots__ = ()

    def __init__(
        self,
        position: Vector,
        intensity: Color | None = None,
        *,
        falloff: Literal["InverseSquare", "None"] | None = None,
        reference: Number | None = None,
        direction: Vector | None = None,
        mu: Number | None = None,
        name: str | None = None,
        attached: Literal["Camera"] | None = None,
    ) -> None:
        super().__init__(
            "Point",
            name=name,
            position=position,
            attached=attached,
            intensity=intensity,
            falloff=falloff,
            reference=reference,
            direction=direction,
            mu=mu,
        )


class Sky(Variant):
    """Light from all directions that no sphere hides; a sky of a single color is just this color: `sky=0.5`.

    Args:
        above: The radiance of the half of the sky that is up, as a color in linear light.
        below: The radiance of the other half.
        up: A vector of any length, across the plane between the halves; (0, 1, 0) by default.
    """

    __slots__ = ()

    def __init__(self, above: Color, below: Color, up: Vector | None = None) -> None:
        super().__init__("Sky", above=above, below=below, up=up)


class Surface(Variant):
    """The grain of a rough material as bumps of the surface: `rough=dict(grain=Surface(12))`.

    Args:
        size: A third of the distance between neighboring bumps, in scene units, greater than 0.
    """

    __slots__ = ()

    def __init__(self, size: Number) -> None:
        super().__init__("Surface", size)


class Units(Variant):
    """The width of an outline in scene units instead of pixels: `outline=dict(width=Units(0.05))`.

    Args:
        width: The difference of the two radii, in scene units, greater than 0.
    """

    __slots__ = ()

    def __init__(self, width: Number) -> None:
        super().__init__("Units", width)
