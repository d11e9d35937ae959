"""Calibration of a light from a shiny ball: the highlight in the picture tells where the light is.

Needs numpy. Prints a few lines.
"""

from __future__ import annotations

from dataclasses import dataclass

import marbles
import numpy as np
from numpy.typing import NDArray

CENTER, RADIUS = np.array([0.3, 0.2, 0.5]), 1.0
TOWARD = np.array([-2.0, 3.0, -4.0])  # what is to be found, in the scene's axes: x right, y up, z forward


@dataclass(frozen=True)
class Result:
    """Angles are in degrees."""

    off_brightest: float
    """How far the light is off if the highlight is taken to be at the center of the brightest pixel."""
    bound_brightest: float
    """What this can be at most: the way to the farthest corner of this pixel, seen in the mirror."""
    off_fit: float
    """How far it is off with a parabola through the pixels around the brightest one."""
    claimed_fit: float
    """How much of that the claimed errors of the pixels allow; the rest comes from the parabola."""


def scene(toward: NDArray[np.float64]) -> marbles.Scene:
    # A black ball: on a ball of another color, the matte light would pull the brightest point toward the light.
    return marbles.Scene(
        image={"width": 240, "height": 240},
        lens=marbles.Fov(28),
        camera=marbles.LookAt(position=(0, 1, -6), target=(0.2, 0.2, 0.5)),
        lights=[marbles.Directional(toward)],
        materials={"black": {"albedo": 0, "highlight": {"strength": 0.9, "shininess": 60}}},
        spheres=[{"center": CENTER, "radius": RADIUS, "material": "black"}],
    )


def mirrored(camera: marbles.Camera, pixels: NDArray[np.float64]) -> NDArray[np.float64]:
    """The direction in which the ball mirrors the view of each point (column, row); (n, 2) to (n, 3)."""
    assert camera.K is not None
    rays = np.column_stack([pixels, np.ones(len(pixels))]) @ np.linalg.inv(camera.K).T @ camera.R
    rays /= np.linalg.norm(rays, axis=1, keepdims=True)
    # The camera is right-handed: there, the z of the scene is negated.
    way = camera.position - CENTER * (1, 1, -1)
    along = rays @ way
    depth = -along - np.sqrt(along**2 - way @ way + RADIUS**2)
    normals = (way + depth[:, None] * rays) / RADIUS
    reflected: NDArray[np.float64] = rays - 2 * np.sum(rays * normals, axis=1, keepdims=True) * normals
    return reflected


def highlight(picture: marbles.Picture) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
    """The brightest pixel, the top of the parabola (both column, row), and how far claims allow it to be off."""
    light, error = picture.light[..., 0], picture.error
    row, col = np.unravel_index(np.argmax(light), light.shape)
    rows, cols = (offsets.ravel() for offsets in np.mgrid[-2:3, -2:3])
    around = (row + rows, col + cols)
    # The logarithm of (n·h)^shininess is nearly a parabola.
    terms = np.column_stack([np.ones(25), cols, rows, cols**2 / 2, cols * rows, rows**2 / 2])
    inverse = np.linalg.pinv(terms)
    _, *slope, xx, xy, yy = inverse @ np.log(light[around])
    to_top = -np.linalg.inv(np.array([[xx, xy], [xy, yy]]))
    brightest = np.array([col, row], float)
    # The largest change of the slope at the top that the errors of all pixels can cause together.
    top = to_top @ slope
    moved = inverse[1:3] + [inverse[3] * top[0] + inverse[4] * top[1], inverse[4] * top[0] + inverse[5] * top[1]]
    off: NDArray[np.float64] = np.abs(to_top @ moved) @ (error[around] / light[around])
    return brightest, brightest + top, off


def degrees(a: NDArray[np.float64], b: NDArray[np.float64]) -> float:
    """The largest angle between unit vectors."""
    return float(np.degrees(2 * np.arcsin(np.linalg.norm(a - b, axis=-1) / 2)).max())


def main(toward: NDArray[np.float64] = TOWARD) -> Result:
    picture = scene(toward).render(1e-6)
    truth = toward * (1, 1, -1) / np.linalg.norm(toward)
    brightest, top, off = highlight(picture)
    from_brightest, from_top = mirrored(picture.camera, np.array([brightest, top]))
    corners = np.array([(x, y) for x in (-1, 1) for y in (-1, 1)])
    result = Result(
        off_brightest=degrees(from_brightest, truth),
        bound_brightest=degrees(mirrored(picture.camera, brightest + corners / 2), from_brightest),
        off_fit=degrees(from_top, truth),
        claimed_fit=degrees(mirrored(picture.camera, top + corners * off), from_top),
    )
    x, y, z = from_top * (1, 1, -1)
    print(f"the highlight is at column {top[0]:.3f}, row {top[1]:.3f}; the light is toward ({x:.5f}, {y:.5f}, {z:.5f})")
    print(f"brightest pixel: off by {result.off_brightest:.2f} degrees, at most {result.bound_brightest:.2f}")
    print(f"parabola: off by {result.off_fit:.5f} degrees, {result.claimed_fit:.5f} of it at most from errors of pixels")
    return result


if __name__ == "__main__":
    main()
