"""Scenes that all compared programs can show: matte spheres, one distant light with hard shadows, black behind them.

The camera looks along z, from some distance before the origin; x points to the right and y up.
"""

import math
import random
from dataclasses import dataclass

Vector = tuple[float, float, float]

PALETTE = [(0.9, 0.3, 0.25), (0.25, 0.6, 0.9), (0.9, 0.8, 0.3), (0.35, 0.75, 0.4), (0.85, 0.85, 0.85), (0.6, 0.4, 0.8)]


@dataclass(frozen=True)
class Sphere:
    center: Vector
    radius: float
    albedo: Vector


@dataclass(frozen=True)
class Scene:
    title: str
    spheres: list[Sphere]
    side: int
    """Pixels of a side of the square picture."""

    distance: float
    """Of the viewpoint from the origin."""

    toward_light: Vector = (-1.0, 1.0, -1.0)
    fov: float = 40.0
    """The horizontal field of view in degrees."""

    @property
    def retina(self) -> float:
        """The width of the retina at the distance 1."""
        return 2 * math.tan(math.radians(self.fov) / 2)


def ball(side: int) -> Scene:
    return Scene("One ball", [Sphere((0.0, 0.0, 0.0), 100.0, (0.9, 0.9, 0.9))], side, distance=340.0)


def hill(side: int) -> Scene:
    """Balls of several sizes that stand on a large one, in each other's shadow."""
    source, ground = random.Random(1), Sphere((0.0, -1010.0, 0.0), 1000.0, (0.8, 0.8, 0.8))
    spheres = [ground]
    while len(spheres) < 61:
        x, z, radius = source.uniform(-100, 100), source.uniform(-100, 100), source.uniform(4, 15)
        y = ground.center[1] + math.sqrt((ground.radius + radius) ** 2 - x**2 - z**2)
        if all(math.dist((x, y, z), other.center) > radius + other.radius for other in spheres[1:]):
            spheres.append(Sphere((x, y, z), radius, source.choice(PALETTE)))
    return Scene("60 balls on a hill", spheres, side, distance=300.0)


def particles(side: int) -> Scene:
    """Particles of several sizes, at random in a cube."""
    source = random.Random(2)

    def particle() -> Sphere:
        x, y, z = (source.uniform(-100, 100) for _ in range(3))
        return Sphere((x, y, z), source.uniform(1.4, 5.6), source.choice(PALETTE))

    return Scene("10,000 particles", [particle() for _ in range(10_000)], side, distance=420.0)
