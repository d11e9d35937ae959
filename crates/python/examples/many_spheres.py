"""Arrays in, a picture out: 100,000 spheres on a knot, colored by a number.

Needs numpy. Writes many_spheres.png, or the file named on the command line.
"""

from __future__ import annotations

import sys
from pathlib import Path

import marbles
import numpy as np
from numpy.typing import NDArray

COUNT = 100_000


def knot(turn: NDArray[np.float64]) -> NDArray[np.float64]:
    """Points of a trefoil knot; (n,) turns to (n, 3)."""
    angle = 2 * np.pi * turn
    x = np.sin(angle) + 2 * np.sin(2 * angle)
    y = np.cos(angle) - 2 * np.cos(2 * angle)
    return np.stack([x, y, -np.sin(3 * angle)], axis=-1)


def main(path: Path = Path("many_spheres.png"), *, count: int = COUNT) -> marbles.Picture:
    random = np.random.default_rng(seed=1)
    turn = random.random(count)
    from_knot = random.normal(size=(count, 3)) * 0.16
    spheres = marbles.Spheres(
        center=knot(turn) + from_knot,
        radius=0.012 + 0.03 * random.random(count) ** 3,
        value=np.linalg.norm(from_knot, axis=1),
        colormap="Plasma",
        range=(0.1, 0.6),
    )
    scene = marbles.Scene(
        image={"width": 640, "height": 640},
        lens=marbles.Fov(30),
        camera=marbles.Frame(fill=0.95),
        ambient=0.3,
        background="#101820",
        lights=[marbles.Directional((-1, 1.5, -1.5), 1.3)],
        spheres=spheres,
    )
    picture = scene.render(1e-2)
    picture.save(path)
    print(f"{len(spheres)} spheres in {path}: error <= {picture.largest_error:.1e}, {picture.over} pixels over")
    return picture


if __name__ == "__main__":
    main(*map(Path, sys.argv[1:]))
