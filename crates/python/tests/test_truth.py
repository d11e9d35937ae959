"""Pictures whose exact values are known in closed form."""

from __future__ import annotations

import math

import marbles
import numpy as np
import pytest


def alone(lens: marbles.Variant, **fields: object) -> marbles.Scene:
    """A sphere with a radius of 1 on the axis of view, ten away, in 41 x 31 pixels."""
    values: dict[str, object] = {
        "image": {"width": 41, "height": 31},
        "lens": lens,
        "camera": marbles.Free(),
        "ambient": (0.5, 0.25, 1),
        "materials": {"m": {"albedo": (0.5, 0.8, 0.3)}},
        "spheres": [{"center": (0, 0, 10), "radius": 1, "material": "m"}],
    }
    return marbles.Scene(**(values | fields))  # type: ignore[arg-type]


@pytest.mark.filterwarnings("ignore::marbles.SceneWarning")
def test_ambient_light_times_albedo() -> None:
    picture = alone(marbles.Fov(20)).render(1e-4, channels=("depth", "normal"))
    np.testing.assert_allclose(picture.light[15, 20], (0.25, 0.2, 0.3), atol=1e-15)
    assert picture.light[0, 0].tolist() == [0, 0, 0]
    assert picture["depth"][15, 20] == 9 and math.isinf(picture["depth"][0, 0])
    np.testing.assert_allclose(picture["normal"][15, 20], (0, 0, -1), atol=1e-15)


@pytest.mark.filterwarnings("ignore::marbles.SceneWarning")
def test_a_ball_alone_under_a_sky_is_as_under_ambient_light() -> None:
    picture = alone(marbles.Fov(20), ambient=0, sky=(0.5, 0.25, 1)).render(1e-4)
    assert np.abs(picture.light[15, 20] - (0.25, 0.2, 0.3)).max() <= picture.error[15, 20] + 1e-12
    # At a normal toward the viewer half of the sky is above.
    halves = marbles.Sky(above=(1, 0.5, 2), below=0)
    picture = alone(marbles.Fov(20), ambient=0, sky=halves).render(1e-4)
    assert np.abs(picture.light[15, 20] - (0.25, 0.2, 0.3)).max() <= picture.error[15, 20] + 1e-12


@pytest.mark.filterwarnings("ignore::marbles.SceneWarning")
@pytest.mark.parametrize("tolerance", [1e-2, 1e-3, 1e-5])
def test_the_coverage_is_the_area_of_the_disk(tolerance: float) -> None:
    pixels_per_unit = 41 / 4
    picture = alone(marbles.Parallel(4)).render(tolerance, alpha=True)
    area, claimed = picture.light[..., 3].sum(), picture.error.sum()
    assert abs(area - math.pi * pixels_per_unit**2) <= claimed
    assert picture.over == 0


@pytest.mark.filterwarnings("ignore::marbles.SceneWarning")
def test_the_coverage_is_the_area_of_the_outline_in_perspective() -> None:
    picture = alone(marbles.Fov(20)).render(1e-5, alpha=True)
    focal = 41 / 2 / math.tan(math.radians(10))
    radius = focal / math.sqrt(10**2 - 1)
    assert abs(picture.light[..., 3].sum() - math.pi * radius**2) <= picture.error.sum()


@pytest.mark.filterwarnings("ignore::marbles.SceneWarning")
def test_light_is_a_mean_of_the_cosine() -> None:
    light = marbles.Directional((0, 0, -1))
    scene = alone(marbles.Parallel(4), ambient=0, lights=[light], materials={"m": {}})
    picture = scene.render(1e-5)
    # The integral of the cosine over the disk is two thirds of its area.
    expected = 2 / 3 * math.pi * (41 / 4) ** 2
    assert abs(picture.light[..., 0].sum() - expected) <= picture.error.sum()
