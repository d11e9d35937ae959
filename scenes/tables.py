"""Writes three tables of this folder: packing.csv, encounter.csv and melt.data.

Usage: tables.py [FOLDER]. It needs NumPy.

packing.dump   grains of different sizes, which have fallen into a box
encounter.xyz  two galaxies shortly after they passed each other, with velocities
melt.dump      chains of beads in a periodic box
"""

import sys
from pathlib import Path

import numpy as np


def neighbors(places: np.ndarray, reach: float, box: float | None = None) -> tuple[np.ndarray, np.ndarray]:
    """The pairs that are closer than this, each once. With a box, images in its neighbors count, too."""
    pairs = []
    for start in range(0, len(places), 256):
        apart = places[None, :] - places[start : start + 256, None]
        if box:
            apart -= box * np.round(apart / box)
        first, second = np.nonzero((apart**2).sum(2) < reach**2)
        pairs.append(np.stack([first + start, second]))
    first, second = np.concatenate(pairs, axis=1)
    return first[first < second], second[first < second]


def packing(count: int = 1200, side: float = 12.0) -> np.ndarray:
    """Grains that fell into a box and rest there: x, y, z (upward) and the radius."""
    random = np.random.default_rng(1)
    radii = random.choice([0.4, 0.55, 0.75, 1.0], count, p=[0.4, 0.3, 0.2, 0.1])
    low = radii[:, None] * np.ones(3)
    places = low + random.random((count, 3)) * (np.array([side, side, 60.0]) - 2 * low)
    speeds, stiffness, step = np.zeros((count, 3)), 4000.0, 0.005
    masses = (radii**3 / 0.125)[:, None]
    for turn in range(9000):
        if turn % 10 == 0:
            first, second = neighbors(places, 2.3)
        apart = places[second] - places[first]
        distance = np.sqrt((apart**2).sum(1))
        overlap = np.maximum(radii[first] + radii[second] - distance, 0)
        push = (stiffness * overlap / distance)[:, None] * apart
        # At the end the grains are light, so that they press each other less.
        forces = -(10.0 if turn < 5000 else 0.5) * masses * [0, 0, 1]
        np.add.at(forces, first, -push)
        np.add.at(forces, second, push)
        forces += stiffness * np.maximum(low - places, 0)
        high = np.array([side, side, np.inf]) - low
        forces -= stiffness * np.maximum(places - high, 0)
        speeds = (speeds + step * forces / masses) * 0.99
        places = places + step * speeds
    return np.column_stack([places, radii])


def encounter(bodies: int = 2000) -> np.ndarray:
    """Two disks of bodies around heavy centers that have passed each other: positions and velocities.

    Source: A. and J. Toomre, "Galactic bridges and tails", 1972. The bodies feel the two centers only.
    """
    random = np.random.default_rng(2)
    softening, step = 0.15, 0.005

    def pull(places: np.ndarray, center: np.ndarray) -> np.ndarray:
        apart = center - places
        return apart / ((apart**2).sum(1, keepdims=True) + softening**2) ** 1.5

    # A parabolic orbit of two centers of mass 1, nearest to each other at distance 2.
    time, nearest = -8.0, 2.0
    mean = 1.5 * time / np.sqrt(nearest**3)
    root = np.cbrt(mean + np.sqrt(mean**2 + 1))
    tangent = root - 1 / root
    place = nearest * np.array([1 - tangent**2, 2 * tangent, 0])
    speed = np.sqrt(4 / nearest) / (1 + tangent**2) * np.array([-tangent, 1, 0])
    centers, speeds = np.array([place, -place]) / 2, np.array([speed, -speed]) / 2
    places, velocities = [], []
    for center, motion, tilt in zip(centers, speeds, (0.3, -0.9)):
        distance, angle = 1.5 * np.sqrt(random.uniform(0.02, 1, bodies // 2)), random.uniform(0, 2 * np.pi, bodies // 2)
        around = np.stack([np.cos(angle), np.sin(angle), 0 * angle], 1)
        along = np.stack([-np.sin(angle), np.cos(angle), 0 * angle], 1)
        turn = np.array([[1, 0, 0], [0, np.cos(tilt), -np.sin(tilt)], [0, np.sin(tilt), np.cos(tilt)]])
        circular = distance / (distance**2 + softening**2) ** 0.75
        places.append(center + (distance[:, None] * around) @ turn.T)
        velocities.append(motion + (circular[:, None] * along) @ turn.T)
    places, velocities = np.concatenate(places), np.concatenate(velocities)
    for _ in range(round((4.0 - time) / step)):
        speeds += step * np.array([pull(centers[:1], centers[1])[0], pull(centers[1:], centers[0])[0]])
        centers = centers + step * speeds
        velocities += step * (pull(places, centers[0]) + pull(places, centers[1]))
        places = places + step * velocities
    return np.column_stack([places, velocities])


def melt(chains: int, beads: int, density: float = 0.85) -> tuple[float, np.ndarray]:
    """The edge of a periodic box, and beads on bonds of length 1 that nearly touch, as in Kremer and Grest's model."""
    random = np.random.default_rng(3)
    count = chains * beads
    box = (count / density) ** (1 / 3)
    steps = random.normal(size=(chains, beads, 3))
    steps /= np.sqrt((steps**2).sum(2, keepdims=True))
    places = (random.random((chains, 1, 3)) * box + np.cumsum(0.97 * steps, axis=1)).reshape(-1, 3)
    speeds = np.zeros_like(places)
    bond = np.flatnonzero(np.arange(count) % beads != beads - 1)
    for turn in range(3000):
        if turn % 10 == 0:
            first, second = neighbors(places, 1.6, box)
        apart = places[second] - places[first]
        apart -= box * np.round(apart / box)
        distance = np.sqrt((apart**2).sum(1))
        push = (50 * np.maximum(1.02 - distance, 0) / distance)[:, None] * apart
        stretch = places[bond + 1] - places[bond]
        length = np.sqrt((stretch**2).sum(1))
        draw = (200 * (length - 0.97) / length)[:, None] * stretch
        forces = np.zeros_like(places)
        for index, force in ((first, -push), (second, push), (bond, draw), (bond + 1, -draw)):
            np.add.at(forces, index, force)
        heat = 0.3 * random.normal(size=places.shape) if turn < 2000 else 0
        speeds = (speeds + 0.01 * forces) * 0.95 + 0.05 * heat
        places = places + 0.01 * speeds
    return box, places


def write_packing(file: Path) -> None:
    grains = packing()
    kinds = {radius: kind + 1 for kind, radius in enumerate(np.unique(grains[:, 3]))}
    high = grains[:, :3].max(0) + 1
    rows = [f"{index + 1} {kinds[r]} {x:.3f} {y:.3f} {z:.3f} {r}" for index, (x, y, z, r) in enumerate(grains)]
    lines = ["ITEM: TIMESTEP", "9000", "ITEM: NUMBER OF ATOMS", f"{len(grains)}", "ITEM: BOX BOUNDS ff ff ff"]
    lines += [f"0 {end:.3f}" for end in high] + ["ITEM: ATOMS id type x y z radius", *rows]
    file.write_text("\n".join(lines) + "\n", encoding="ascii")


def write_encounter(file: Path) -> None:
    bodies = encounter()
    rows = [" ".join(f"{number:.3f}" for number in body) for body in bodies]
    lines = [f"{len(bodies)}", "Properties=pos:R:3:velocity:R:3", *rows]
    file.write_text("\n".join(lines) + "\n", encoding="ascii")


def write_melt(file: Path) -> None:
    chains, beads = 12, 120
    box, places = melt(chains, beads)
    lines = ["ITEM: TIMESTEP", "3000", "ITEM: NUMBER OF ATOMS", f"{len(places)}", "ITEM: BOX BOUNDS pp pp pp"]
    lines += [f"0 {box:.4f}"] * 3 + ["ITEM: ATOMS id mol type x y z ix iy iz"]
    for index, place in enumerate(places):
        flags = np.floor(place / box).astype(int)
        numbers = " ".join(f"{number:.3f}" for number in place - box * flags)
        lines.append(f"{index + 1} {index // beads + 1} 1 {numbers} {flags[0]} {flags[1]} {flags[2]}")
    file.write_text("\n".join(lines) + "\n", encoding="ascii")


if __name__ == "__main__":
    folder = Path(sys.argv[1]) if len(sys.argv) > 1 else Path(__file__).parent
    write_packing(folder / "packing.dump")
    write_encounter(folder / "encounter.xyz")
    write_melt(folder / "melt.dump")
