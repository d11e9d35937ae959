"""Pictures: arrays, options, channels, cameras."""

from __future__ import annotations

import math

import marbles
import numpy as np
import pytest
from conftest import ball, same


def test_a_short_scene_renders() -> None:
    picture = ball().render()
    assert picture.light.shape == (32, 48, 3)
    assert picture.over == 0 and picture.frame == 1
    assert 0 < picture.largest_error <= 1e-3
    assert picture.largest_error == picture.error.max()
    assert picture.light.max() > 0.5
    assert "48 x 32" in repr(picture) and picture.size == (48, 32)
    assert picture._repr_png_().startswith(b"\x89PNG")


def test_arrays_have_the_shapes_and_types_that_are_promised() -> None:
    names = ("depth", "normal", "position", "albedo", "id", "mask", "mean_normal", "coverage_id")
    picture = ball().render(1e-2, channels=names)
    expected = {
        "light": (np.float64, 3), "error": (np.float64, 0), "bound": (np.bool_, 0), "depth": (np.float64, 0),
        "normal": (np.float64, 3), "position": (np.float64, 3), "albedo": (np.float64, 3), "id": (np.uint32, 0),
        "mask": (np.float64, 0), "mean_normal": (np.float64, 3), "mean_normal_error": (np.float64, 0),
        "coverage_id": (np.uint32, 0), "coverage_share": (np.float64, 0), "coverage_error": (np.float64, 0),
    }  # fmt: skip
    assert set(picture.channels) == set(expected) - {"light", "error", "bound"}
    for name, (kind, components) in expected.items():
        array = picture[name]
        assert array.dtype == kind, name
        assert array.shape == ((32, 48, components) if components else (32, 48)), name
        assert array.flags.c_contiguous, name
        assert picture[name] is array, name
    with pytest.raises(KeyError, match="expected one of light.*found 'z'"):
        picture["z"]
    assert "depth" in picture and "z" not in picture


def test_arrays_outlive_their_picture() -> None:
    picture = ball().render(1e-2)
    light = picture.light
    copy = light.copy()
    del picture
    for _ in range(3):
        ball().render(1e-2)
    assert same(light, copy)
    assert light.flags.owndata or light.base is not None


def test_channels_agree_with_the_camera() -> None:
    scene = ball()
    picture = scene.render(1e-2, channels=("position", "id", "depth"))
    camera = picture.camera
    assert camera.K is not None and camera.K.shape == (3, 3)
    assert math.isclose(np.linalg.det(camera.R), 1)
    np.testing.assert_allclose(camera.position, -camera.R.T @ camera.t, atol=1e-12)
    rows, columns = np.nonzero(picture["id"] != 0xFFFFFFFF)
    points = picture["position"][rows, columns] * (1, 1, -1) @ camera.R.T + camera.t
    np.testing.assert_allclose(points[:, 2], picture["depth"][rows, columns], rtol=1e-9)
    pixels = points @ camera.K.T / points[:, 2:]
    np.testing.assert_allclose(pixels[:, :2], np.stack([columns, rows], 1), atol=1e-6)
    still = scene.camera()
    for name in ("K", "R", "t", "position"):
        assert same(getattr(still, name), getattr(camera, name))
    with pytest.raises(AttributeError):
        camera.t = camera.position  # type: ignore[misc]


def test_a_parallel_lens_has_no_matrix() -> None:
    camera = ball(lens=marbles.Parallel(8)).render(1e-2).camera
    assert camera.K is None
    assert camera.pixels_per_unit == 6
    assert camera.principal_point is not None and camera.principal_point.tolist() == [23.5, 15.5]


def test_options_are_those_of_the_command() -> None:
    scene = ball()
    whole = scene.render(1e-2)
    part = scene.render(1e-2, region=(5, 7, 20, 10))
    assert same(part.light, np.ascontiguousarray(whole.light[7:17, 5:25]))
    assert scene.render(1e-2, size=(24, 16)).light.shape == (16, 24, 3)
    assert same(scene.render(1e-2, threads=1).light, whole.light)
    cut = scene.render(1e-2, alpha=True)
    assert cut.light.shape == (32, 48, 4)
    assert cut.to_srgb().shape == (32, 48, 4)
    sampled = scene.render(samples=1)
    assert sampled.largest_error == math.inf and np.isinf(sampled.error).all()
    assert whole.to_srgb().dtype == np.uint8 and whole.to_srgb().shape == (32, 48, 3)
    assert scene.render(1e-2, channels="depth,mask").channels == ("depth", "mask")


def test_lights_add_up() -> None:
    lights = [marbles.Directional((-1, 1.5, -1), name="sun"), marbles.Point((2, 3, -2), 0.4, reference=2)]
    picture = ball(lights=lights, background=0.2).render(1e-3, per_light=True)
    assert list(picture.per_light) == ["light-sun", "light-2", "ambient"] or list(picture.per_light)[-1] == "ambient"
    assert len(picture.per_light) == 3
    total = sum(part.light for part in picture.per_light.values())
    claimed = picture.error + sum(part.error for part in picture.per_light.values())
    assert (np.abs(total - picture.light).max(axis=-1) <= claimed + 1e-12).all()


def test_the_sky_is_a_light_of_its_own_name() -> None:
    sun = marbles.Directional((-1, 1.5, -1), name="sun", diameter=3)
    scene = ball(lights=[sun], sky=marbles.Sky(above=(0.2, 0.3, 0.5), below=0.1), image={"width": 24, "height": 16})
    picture = scene.render(1e-2, per_light=True)
    assert list(picture.per_light) == ["sun", "sky", "ambient"]
    total = sum(part.light for part in picture.per_light.values())
    claimed = picture.error + sum(part.error for part in picture.per_light.values())
    assert (np.abs(total - picture.light).max(axis=-1) <= claimed + 1e-12).all()
    assert picture.sidecar["lights"][0]["diameter_degrees"] == 3
    assert picture.sidecar["sky"] == {"above": [0.2, 0.3, 0.5], "below": [0.1, 0.1, 0.1], "up": [0, 1, 0]}
    assert "sky" not in picture.per_light["sun"].sidecar
    with pytest.raises(ValueError, match="two lights would share the picture `sky`"):
        scene.replace(lights=[marbles.Directional((0, 1, 0), name="sky")]).render(1e-1, per_light=True)


def test_sidecars_have_the_results() -> None:
    picture = ball().render(1e-2)
    assert picture.sidecar["over"] == picture.over
    assert picture.sidecar["image"] == {"width": 48, "height": 32}
    assert picture.sidecar["tolerance"] == 1e-2
    assert picture.sidecar is picture.sidecar


@pytest.mark.parametrize(
    ("options", "error", "message"),
    [
        ({"tolerance": -1}, ValueError, None),
        ({"tolerance": math.nan}, ValueError, None),
        ({"tolerance": "1e-3"}, TypeError, "tolerance: expected a number"),
        ({"samples": 0}, ValueError, "samples: "),
        ({"samples": 1.5}, TypeError, "samples: expected a whole number, found float"),
        ({"frame": 2}, ValueError, "frame: expected 1, found 2"),
        ({"frame": "1"}, TypeError, "frame: "),
        ({"frame": 2**40}, ValueError, "frame: "),
        ({"channels": ["deep"]}, ValueError, None),
        ({"channels": [1]}, TypeError, "channels: "),
        ({"size": (0, 5)}, ValueError, r"size\[0\]: expected a whole number from 1 to 65536, found 0"),
        ({"size": (5,)}, ValueError, r"size: expected \(width, height\), found 1 numbers"),
        ({"size": 5}, TypeError, "size: "),
        ({"region": (0, 0, 10**6, 1)}, ValueError, r"region\[2\]: "),
        ({"region": (40, 0, 20, 10)}, ValueError, None),
        ({"threads": 0}, ValueError, "threads: "),
        ({"depth": "deep"}, ValueError, None),
        ({"axes": 7}, TypeError, "axes: "),
    ],
)
def test_wrong_options_are_refused(options: dict[str, object], error: type[Exception], message: str | None) -> None:
    with pytest.raises(error, match=message):
        ball().render(**options)  # type: ignore[arg-type]


def test_pictures_are_compared() -> None:
    scene = ball()
    rough, fine = scene.render(1e-2), scene.render(1e-4)
    found = marbles.compare(rough, fine)
    assert found.beyond == 0
    assert 0 < found.mean <= found.rms <= found.max <= 1e-2 + 1e-4
    assert marbles.compare(fine, fine) == marbles.Comparison(0.0, 0.0, 0.0, 0)
    assert marbles.compare(rough.light, fine.light).max == found.max
    assert marbles.compare(np.array([1, 2], np.float32), [1, 4]) == marbles.Comparison(2.0, 1.0, math.sqrt(2))
    with pytest.raises(ValueError, match=r"b: expected an array of the shape \(32, 48, 3\), found \(2,\)"):
        marbles.compare(rough, np.zeros(2))
    with pytest.raises(TypeError, match="b: expected real numbers"):
        marbles.compare(rough, rough.light > 0)
