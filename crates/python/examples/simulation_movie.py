"""A movie of a simulation that runs in numpy: balls fall onto a floor and bounce off each other.

Needs numpy. Writes PNG files to a temporary folder, or to the folder named on the command line. If Pillow can be
imported, it makes a GIF of them.
"""

from __future__ import annotations

import sys
import tempfile
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path

import marbles
import numpy as np
from numpy.typing import NDArray

BALLS, FRAMES, STEPS = 250, 30, 8  # steps per frame
SECONDS = 1 / (24 * STEPS)  # of a step
HALF = 3.0  # the walls are at ±HALF in x and z, and the floor is at y = 0
FLOOR = {"center": (0, -2000, 0), "radius": 2000, "material": "floor"}


class Simulation:
    """Balls of different sizes; lengths in meters, y up."""

    def __init__(self, count: int) -> None:
        random = np.random.default_rng(seed=3)
        self.radius = random.uniform(0.12, 0.3, count)
        places = np.stack(np.meshgrid(*[np.arange(-2.4, 2.5, 0.7)] * 2, np.arange(1, 6.2, 0.7), indexing="ij"), axis=-1)
        self.center = random.permutation(places.reshape(-1, 3))[:count][:, [0, 2, 1]]
        self.velocity = random.normal(scale=1.0, size=(count, 3))
        self.mass = self.radius**3

    def step(self) -> None:
        self.velocity[:, 1] -= 9.81 * SECONDS
        self.center += self.velocity * SECONDS
        self._walls()
        self._collisions()

    def _walls(self) -> None:
        for axis, sign, wall in ((0, 1, HALF), (0, -1, HALF), (2, 1, HALF), (2, -1, HALF), (1, -1, 0.0)):
            beyond = sign * self.center[:, axis] + self.radius - wall
            hits = beyond > 0
            self.center[hits, axis] -= sign * beyond[hits]
            outward = hits & (sign * self.velocity[:, axis] > 0)
            self.velocity[outward, axis] *= -0.7

    def _collisions(self) -> None:
        ways = self.center[:, None] - self.center
        distances = np.linalg.norm(ways, axis=-1)
        first, second = np.nonzero(np.triu(distances < self.radius[:, None] + self.radius, k=1))
        way = ways[first, second] / distances[first, second, None]
        # Balls that overlap are pushed apart; if they approach each other, they bounce. Light balls move more.
        shares = np.stack([self.mass[second], -self.mass[first]]) / (self.mass[first] + self.mass[second])
        overlap = self.radius[first] + self.radius[second] - distances[first, second]
        approach = -np.sum((self.velocity[first] - self.velocity[second]) * way, axis=1)
        for balls, share in zip((first, second), shares):
            np.add.at(self.center, balls, (share * 0.5 * overlap)[:, None] * way)
            np.add.at(self.velocity, balls, (share * 1.8 * np.maximum(approach, 0))[:, None] * way)

    def spheres(self) -> marbles.Spheres:
        speed: NDArray[np.float64] = np.linalg.norm(self.velocity, axis=1)
        return marbles.Spheres(
            self.center, self.radius, value=speed, colormap="Inferno", range=(0, 9), material="ball"
        )


def main(folder: Path | None = None, *, frames: int = FRAMES) -> tuple[int, float]:
    """Returns the number of frames and the largest error of any pixel."""
    folder = folder or Path(tempfile.mkdtemp(prefix="marbles-"))
    simulation = Simulation(BALLS)
    scene = marbles.Scene(
        image={"width": 320, "height": 240},
        lens=marbles.Fov(40),
        camera=marbles.LookAt(position=(3, 4, -12), target=(0, 2, 0)),
        ambient=0.25,
        background="#101820",
        lights=[marbles.Directional((-1, 2, -1.5), 0.75)],
        materials={"ball": {"highlight": {"strength": 0.3}}, "floor": {"albedo": 0.5}},
        spheres=[FLOOR, simulation.spheres()],
    )
    pictures, errors = [], []
    for frame in range(1, frames + 1):
        picture = scene.replace(spheres=[FLOOR, simulation.spheres()]).render(1e-2)
        picture.save(folder / f"balls.{frame:04}.png")
        pictures.append(picture.to_srgb())
        errors.append(picture.largest_error)
        for _ in range(STEPS):
            simulation.step()
    print(f"{frames} frames in {folder}, error <= {max(errors):.1e}")
    if find_spec("PIL"):
        first, *others = map(import_module("PIL.Image").fromarray, pictures)
        first.save(folder / "balls.gif", save_all=True, append_images=others, duration=1000 // 24, loop=0)
        print(f"a loop in {folder / 'balls.gif'}")
    else:
        print("Pillow is not installed: no GIF is made")
    return frames, max(errors)


if __name__ == "__main__":
    main(*map(Path, sys.argv[1:]))
