"""Photometric stereo from end to end: a ball under six lights, its normals by least squares, and how far they are off.

Needs numpy. Prints a few lines.
"""

from __future__ import annotations

from dataclasses import dataclass

import marbles
import numpy as np
from numpy.typing import NDArray

ALBEDO = 0.8
# Toward the lights, in the scene's axes: x right, y up, z away from the camera.
DIRECTIONS = [(0, 0, -1), (3, 1, -4), (-3, 1, -4), (0, 3, -4), (1, -3, -4), (-2, -2, -5)]


@dataclass(frozen=True)
class Result:
    """Angles are in degrees."""

    pixels: int
    off_mean_normal: float
    """The largest angle between a recovered normal and the mean normal of its pixel."""
    claimed: float
    """The largest angle that the claimed errors of the pictures allow."""
    off_center: float
    """The largest angle between a recovered normal and the normal at the center of its pixel."""
    albedo: float
    """The largest error of the recovered albedo times the length of the mean normal."""


def scene() -> marbles.Scene:
    return marbles.Scene(
        image={"width": 160, "height": 160},
        lens=marbles.Fov(30),
        camera=marbles.Free(position=(0, 0, -4.3)),
        lights=[marbles.Directional(toward) for toward in DIRECTIONS],
        materials={"matte": {"albedo": ALBEDO}},
        spheres=[{"center": (0, 0, 0), "radius": 1, "material": "matte"}],
    )


def angles(a: NDArray[np.float64], b: NDArray[np.float64]) -> NDArray[np.float64]:
    """The angles between vectors of any length, (n, 3), in degrees; exact for small ones, too."""
    a, b = (v / np.linalg.norm(v, axis=-1, keepdims=True) for v in (a, b))
    degrees: NDArray[np.float64] = np.degrees(2 * np.arcsin(np.linalg.norm(a - b, axis=-1) / 2))
    return degrees


def main() -> Result:
    channels = ("normal", "mean_normal", "coverage_id")
    picture = scene().render(1e-7, per_light=True, channels=channels)
    pictures = [picture.per_light[f"light-{index + 1}"] for index in range(len(DIRECTIONS))]
    measured = np.stack([single.light[..., 0] for single in pictures])  # (lights, height, width)
    error = np.stack([single.error for single in pictures])

    directions = np.array(DIRECTIONS, float)
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    inverse = np.linalg.pinv(directions)
    found = np.einsum("nl,lhw->hwn", inverse, measured)  # albedo times normal

    # A pixel that a light reaches only in part is no linear function of a normal. It shows in the residuals: where all
    # lights reach the whole pixel, they are no larger than the claimed errors allow.
    residual = measured - np.einsum("ln,hwn->lhw", directions, found)
    allowed = np.einsum("lk,khw->lhw", np.abs(np.eye(len(directions)) - directions @ inverse), error)
    whole = picture["coverage_share"] >= 1 - picture["coverage_error"]
    lit = whole & (measured.min(axis=0) > 0) & (np.abs(residual) <= allowed).all(axis=0)

    # A pixel is the average over its square, and the light of a matte surface is linear in the normal. So what comes
    # out is the mean normal of the pixel, times the albedo. The mean is shorter than 1, and it is not the normal at the
    # pixel's center: where the ball curves away, they differ by more than a thousandth of a degree.
    mean, center = picture["mean_normal"][lit], picture["normal"][lit]
    off = np.linalg.norm(np.einsum("nl,lp->np", np.abs(inverse), error[:, lit]), axis=0) / ALBEDO
    off += np.sqrt(3) * picture["mean_normal_error"][lit]
    lengths = np.linalg.norm(mean, axis=1)
    result = Result(
        pixels=int(lit.sum()),
        off_mean_normal=float(angles(found[lit], mean).max()),
        claimed=float(np.degrees(np.arcsin(off / lengths)).max()),
        off_center=float(angles(found[lit], center).max()),
        albedo=float(np.abs(np.linalg.norm(found[lit], axis=1) - ALBEDO * lengths).max()),
    )
    print(f"{result.pixels} of {int(whole.sum())} pixels see all {len(DIRECTIONS)} lights")
    print(f"off the mean normals by at most {result.off_mean_normal:.1e} degrees; claimed: {result.claimed:.1e}")
    print(f"off the normals at the centers of pixels by at most {result.off_center:.1e} degrees")
    return result


if __name__ == "__main__":
    main()
