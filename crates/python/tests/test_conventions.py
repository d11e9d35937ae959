"""What a user of Python expects of any package."""

from __future__ import annotations

import copy
import pickle
import warnings
from pathlib import Path

import marbles
import numpy as np
import pytest
from conftest import ball


def test_scenes_are_copied_and_pickled(tmp_path: Path) -> None:
    centers = np.array([[0.0, 0, 5], [1, 0, 6]])
    scene = ball(spheres=marbles.Spheres(centers, 0.5))
    light = scene.render(1e-2).light
    for other in (copy.deepcopy(scene), pickle.loads(pickle.dumps(scene))):
        assert other.text == scene.text
        assert np.array_equal(other.render(1e-2).light, light)
    scene.save(tmp_path / "a.ron")
    loaded = pickle.loads(pickle.dumps(marbles.load(tmp_path / "a.ron")))
    assert np.array_equal(loaded.render(1e-2).light, light)


def test_files_that_are_not_there_are_errors_of_the_system(tmp_path: Path) -> None:
    with pytest.raises(FileNotFoundError):
        marbles.load(tmp_path / "none.ron")
    with pytest.raises(OSError, match="cannot create the file|no such folder|does not exist"):
        ball().render(1e-1).save(tmp_path / "none" / "a.png")


def test_exceptions_have_the_name_of_the_package() -> None:
    assert marbles.SceneError.__module__ == "marbles"
    assert marbles.RenderError.__module__ == "marbles"


def test_options_that_contradict_each_other_are_refused(tmp_path: Path) -> None:
    scene = ball()
    with pytest.raises(ValueError, match="samples: expected no `tolerance` beside it"):
        scene.render(1e-5, samples=4)
    with pytest.raises(ValueError, match=r"frames\[1\]: expected each frame once, found 1 again"):
        scene.frames(frames=[1, 1])
    with pytest.raises(ValueError, match="^region: "):
        scene.render(region=(0, 0, 0, 5))
    with pytest.raises(ValueError, match="^error is for EXR"):
        scene.render(1e-1).save(tmp_path / "a.png", error=True)
    with pytest.raises(ValueError, match="^layout: "):
        marbles.dataset("a.ron", tmp_path, layout="foo")  # type: ignore[arg-type]


def test_bytes_are_srgb_codes_wherever_a_color_is_wanted() -> None:
    codes = np.array([0, 128, 255], np.uint8)
    picture = ball(spheres=[], background=codes).render(1e-3)
    assert np.array_equal(picture.light[0, 0], ball(spheres=[], background="#0080ff").render(1e-3).light[0, 0])


def test_a_warning_is_issued_once_for_a_scene_and_those_made_of_it() -> None:
    with pytest.warns(marbles.SceneWarning, match="not used"):
        scene = ball(materials={"candy": {}, "unused": dict(albedo=0.5)})
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        scene.replace(zoom=2)
    with pytest.warns(marbles.SceneWarning, match="no sphere is in view"):
        scene.replace(spheres=[dict(center=(0, 0, -50), radius=1)]).render(1e-1)


@pytest.mark.parametrize("lens", [marbles.Fov(40), marbles.Parallel(8), marbles.Matrix(fx=60, fy=75, cx=20, cy=12)])
def test_points_are_projected_to_the_pixels_that_see_them(lens: marbles.Variant) -> None:
    camera = marbles.LookAt(position=(1, 2, -9), target=(0, 0.3, 0), roll=20)
    scene = ball(lens=lens, camera=camera, spheres=[dict(center=(0, 0, 0), radius=1.5)])
    picture = scene.render(1e-1, channels=("position", "mask"))
    rows, columns = np.nonzero(picture["mask"])
    assert len(rows) > 20
    found = picture.camera.project(picture["position"][rows, columns])
    assert np.abs(found - np.stack((columns, rows), -1)).max() < 1e-9
    if not isinstance(lens, marbles.Parallel):
        assert np.isnan(picture.camera.project((1, 2, -10))).all()
