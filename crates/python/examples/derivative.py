"""The derivative of a picture with respect to the position of a ball, with error bars from the claimed errors.

marbles computes no derivatives. Differences of pictures replace them, because the errors of both pictures are known. A
ball leaves the picture at the right edge, so the derivatives of two sums over all pixels are known in closed form.

Needs numpy. Prints a few lines.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import marbles
import numpy as np
from numpy.typing import NDArray

WIDTH, HEIGHT, UNITS = 60, 45, 4.0  # of the picture: pixels, pixels, and scene units from left to right
PER_UNIT = WIDTH / UNITS  # pixels per scene unit
X = 1.6  # the center of the ball, whose radius is 1; the right edge of the picture is at x = 2


@dataclass(frozen=True)
class Derivative:
    """Per scene unit."""

    value: NDArray[np.float64]
    """The difference of two pictures, divided by that of the positions, (height, width, 4), alpha last."""
    error: NDArray[np.float64]
    """How far this is at most from the mean derivative between the two positions: a claim, (height, width)."""


@dataclass(frozen=True)
class Sum:
    """A derivative of a sum over all pixels, in pixels per scene unit."""

    value: float
    claimed: float
    """The part of the error that the pixels' errors can cause."""
    truncated: float
    """An estimate of the part that comes from the step."""
    truth: float


def picture(x: float) -> marbles.Picture:
    scene = marbles.Scene(
        image={"width": WIDTH, "height": HEIGHT},
        lens=marbles.Parallel(UNITS),
        camera=marbles.Free(position=(0, 0, -5)),
        lights=[marbles.Directional((0, 0, -1))],
        spheres=[{"center": (x, 0, 0), "radius": 1}],
    )
    return scene.render(1e-6, alpha=True)


def derivative(x: float, step: float) -> Derivative:
    after, before = picture(x + step), picture(x - step)
    return Derivative(
        (after.light - before.light) / (2 * step),
        (after.error + before.error) / (2 * step),
    )


def summed(fine: Derivative, coarse: Derivative, channel: int, truth: float) -> Sum:
    """The sum over all pixels, from a step and one that is twice as large.

    Central differences are off by about c·step². With twice the step that is 4 c·step², so a third of the difference
    of both is an estimate of c·step². It holds for smooth functions, as these sums are. A single pixel is no smooth
    function of x: its derivative has kinks where the outline passes its corners.
    """
    value = fine.value[..., channel].sum()
    truncated = abs(coarse.value[..., channel].sum() - value) / 3
    claimed = fine.error.sum() + (fine.error.sum() + coarse.error.sum()) / 3
    return Sum(float(value), float(claimed), float(truncated), truth)


def main(step: float = 5e-3) -> tuple[Sum, Sum]:
    fine, coarse = derivative(X, step), derivative(X, 2 * step)
    inside = UNITS / 2 - X  # from the center to the edge of the picture, in radii
    # The chord at the edge, and the light along it: the integral of √(1 − inside² − y²).
    chord = -(PER_UNIT**2) * 2 * math.sqrt(1 - inside**2)
    light = -(PER_UNIT**2) * math.pi / 2 * (1 - inside**2)
    coverage, brightness = summed(fine, coarse, 3, chord), summed(fine, coarse, 0, light)
    bar = fine.error[np.abs(fine.value[..., 3]) > 0.01].max()
    least, most = fine.value[..., 3].min(), fine.value[..., 3].max()
    print(f"d alpha / dx of single pixels: between {least:.3f} and {most:.3f} ± {bar:.1e}")
    for name, result in (("coverage", coverage), ("light", brightness)):
        print(
            f"d {name} / dx = {result.value:.5f} ± {result.claimed:.5f} (claimed) ± {result.truncated:.5f} (step);"
            f" exactly {result.truth:.5f}"
        )
    return coverage, brightness


if __name__ == "__main__":
    main()
