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
    """How far the light can be off if the highlight is anywhere in this pixel."""
    off_fit: float
    """How far it is off with a parabola through the pixels around the brightest one."""
    claimed_fit: float
    """How much of that the claimed errors of the pixels can cause; the rest comes from the parabola."""


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


def normals_at(camera: marbles.Camera, pixels: NDArray[np.float64]) -> NDArray[np.float64]:
    """The normals of the ball at points (column, row), in the camera's world; (n, 2) to (n, 3)."""
    assert camera.K is not None
    rays = np.column_stack([pixels, np.ones(len(pixels))]) @ np.linalg.inv(camera.K).T @ camera.R
    rays /= np.linalg.norm(rays, axis=1, keepdims=True)
    # This world is right-handed: the z of the scene is negated.
    way = camera.position - CENTER * (1, 1, -1)
    along = rays @ way
    distance = -along - np.sqrt(along**2 - way @ way + RADIUS**2)
    normals: NDArray[np.float64] = (way + distance[:, None] * rays) / RADIUS
    return normals


def mirrored(camera: marbles.Camera, normals: NDArray[np.float64]) -> NDArray[np.float64]:
    """The directions in which the camera sees the ball mirror its surroundings; (n, 3) to (n, 3)."""
    normals = normals / np.linalg.norm(normals, axis=1, keepdims=True)
    rays = CENTER * (1, 1, -1) + RADIUS * normals - camera.position
    rays /= np.linalg.norm(rays, axis=1, keepdims=True)
    directions: NDArray[np.float64] = rays - 2 * np.sum(rays * normals, axis=1, keepdims=True) * normals
    return directions


def degrees(a: NDArray[np.float64], b: NDArray[np.float64]) -> float:
    """The largest angle between unit vectors."""
    return float(np.degrees(2 * np.arcsin(np.linalg.norm(a - b, axis=-1) / 2)).max())


def main(toward: NDArray[np.float64] = TOWARD) -> Result:
    picture = scene(toward).render(1e-6)
    light, camera = picture.light[..., 0], picture.camera
    row, col = np.unravel_index(np.argmax(light), light.shape)
    corners = np.array([(x, y) for x in (-1, 1) for y in (-1, 1)])
    brightest = mirrored(camera, normals_at(camera, np.array([(col, row), *((col, row) + corners / 2)])))

    # The logarithm of the light, (n·h)^shininess, is nearly a parabola over the plane that touches the ball there.
    rows, cols = (offsets.ravel() for offsets in np.mgrid[-2:3, -2:3])
    around = (row + rows, col + cols)
    normals = normals_at(camera, np.column_stack([col + cols, row + rows]))
    middle = normals[12]
    plane = np.linalg.svd(middle[None])[2][1:]
    x, y = (normals / (normals @ middle)[:, None] @ plane.T).T
    inverse = np.linalg.pinv(np.column_stack([np.ones(25), x, y, x**2 / 2, x * y, y**2 / 2]))
    _, *slope, xx, xy, yy = inverse @ np.log(light[around])
    to_top = -np.linalg.inv([[xx, xy], [xy, yy]])
    top = to_top @ slope
    # If the logarithms are off by as much as is claimed, the slope at the top is not quite zero.
    slopes = inverse[1:3] + np.array([top @ inverse[3:5], top @ inverse[4:6]])
    off = np.abs(to_top @ slopes) @ (picture.error[around] / light[around])
    found, *others = mirrored(camera, middle + np.array([top, *(top + corners * off)]) @ plane)

    truth = toward * (1, 1, -1) / np.linalg.norm(toward)
    result = Result(
        off_brightest=degrees(brightest[0], truth),
        bound_brightest=degrees(brightest[1:], brightest[0]),
        off_fit=degrees(found, truth),
        claimed_fit=degrees(np.array(others), found),
    )
    x, y, z = found * (1, 1, -1)
    print(f"the light is toward ({x:.5f}, {y:.5f}, {z:.5f})")
    print(f"brightest pixel: off by {result.off_brightest:.2f} degrees, at most {result.bound_brightest:.2f}")
    print(f"parabola: off by {result.off_fit:.5f} degrees; errors of pixels cause at most {result.claimed_fit:.5f}")
    return result


if __name__ == "__main__":
    main()
