"""Scenes: fields, faults, warnings, other values, tables of spheres."""

from __future__ import annotations

import copy
import pickle
import warnings
from pathlib import Path

import marbles
import numpy as np
import pytest
from conftest import ROOT, ball, same

TEXT = """// A ball.
(
    image: (width: 48, height: 32), // small
    lens: Fov(40),
    camera: Free(position: (0, 0, -10)),
    ambient: 0.5,
    lights: [Directional(toward: (0, 0, -1), name: "sun")],
    spheres: [(center: (0, 0, 0), radius: 1), (center: (2, 0, 0), radius: 0.5)],
)
"""


def test_a_text_is_kept() -> None:
    scene = marbles.loads(TEXT)
    assert scene.text == TEXT
    assert scene.size == (48, 32)
    assert scene.frame_range is None and scene.frames_per_second is None
    assert scene.lights == ["sun"] and scene.materials == []
    assert "48 x 32" in repr(scene)


def test_scenes_cannot_be_changed() -> None:
    scene = marbles.loads(TEXT)
    with pytest.raises(AttributeError, match="replace"):
        scene.text = ""  # type: ignore[misc]
    scene.lights.append("moon")
    assert scene.lights == ["sun"]


def test_dicts_do_as_well_as_variants() -> None:
    variants = ball(animation=marbles.Turntable(frames=3), camera=marbles.Orbit((0, 0, 0), 9))
    dicts = ball(
        lens={"Fov": 40},
        camera={"Orbit": {"target": [0, 0, 0], "radius": 9}},
        lights=[{"Directional": {"name": "sun", "toward": np.array([-1, 1.5, -1])}}],
        animation={"Turntable": {"frames": 3}},
    )
    assert same(variants.render(1e-2).light, dicts.render(1e-2).light)
    assert variants.frame_range == dicts.frame_range == (1, 3)
    assert dicts.frames_per_second == 24


def test_json_is_read() -> None:
    text = '{"image": {"width": 48, "height": 32}, "lens": {"Fov": 40}, "camera": {"Free": {"pan": 5}}, "ambient": 1, \
"spheres": [{"center": [0, 0, 9], "radius": 1}], "unit": null}'
    scene = marbles.loads(text)
    moved = scene.replace(camera=marbles.Free(pan=6))
    assert scene.render(1e-2).light.max() > 0.9
    assert not same(scene.render(1e-2).light, moved.render(1e-2).light)


def test_faults_have_their_places() -> None:
    with pytest.raises(marbles.SceneError) as caught:
        marbles.loads(TEXT.replace("radius: 0.5", "radius: -1"))
    error = caught.value
    assert isinstance(error, ValueError)
    assert (error.path, error.line) == ("spheres[1].radius", 8)
    assert error.column == 1 + TEXT.splitlines()[7].index("0.5")
    assert error.faults[0].message == "expected a radius greater than 0, found -1"
    with pytest.raises(marbles.SceneError) as caught:
        ball(spheres=[{"center": (0, 0, 0), "radius": -1}])
    assert (caught.value.path, caught.value.line, caught.value.column) == ("spheres[0].radius", None, None)
    assert str(caught.value).startswith("spheres[0].radius: expected a radius greater than 0, found -1")


def test_faults_of_arrays_have_their_names_in_python() -> None:
    array = marbles.Spheres([(0, 0, 0)], material="nope")
    for given, path in ((array, "spheres"), ([{"center": (5, 5, 5), "radius": 1}, array], "spheres[1]")):
        with pytest.raises(marbles.SceneError) as caught:
            ball(spheres=given)
        assert caught.value.path == f"{path}.material"
    with pytest.raises(marbles.SceneError) as caught:
        ball(spheres=[array, {"center": (5, 5, 5), "radius": -1}, {"center": 1, "radius": 1}], materials={"nope": {}})
    assert [fault for fault in str(caught.value).splitlines() if fault.startswith("spheres[1].radius: ")]
    with pytest.raises(marbles.SceneError) as caught:
        ball(spheres=marbles.Spheres([(0, 0, 0)], color="blurple"))
    assert caught.value.path == "spheres.color"
    with pytest.raises(marbles.SceneError) as caught:
        ball(spheres=marbles.Spheres([(0, 0, 0)], keep=[("value", marbles.Is(2))]))
    assert str(caught.value).startswith("spheres: expected a column `value`, found `x`, `y`, `z`")
    assert caught.value.path == "spheres"
    with pytest.raises(marbles.SceneError) as caught:
        ball(materials={"a b": {"albedo": -1}, "candy": {}})
    assert caught.value.path == 'materials["a b"].albedo'
    with pytest.raises(marbles.SceneError) as caught:
        ball(spheres=marbles.Spheres([(0, 0, 0)]), clouds=[{"file": "there_is_no_such_file.csv"}])
    assert "there_is_no_such_file" in str(caught.value)


@pytest.mark.parametrize(
    ("fields", "message"),
    [
        ({"camera": {"Free": {"pan": float("nan")}}}, "camera.pan: expected a finite number, found nan"),
        ({"materials": {"a": {"albedo": object()}}}, 'materials["a"].albedo: expected '),
        ({"spheres": [{"center": (0, None, 0), "radius": 1}]}, "spheres[0].center[1]: expected "),
        ({"spheres": {"center": (0, 0, 0), "radius": 1}}, "spheres: expected "),
        ({"lens": {"Fov": 40, "Free": 1}}, "lens: expected nothing beside 'Fov' in its dict, found 'Free'"),
        ({"image": {1: 2}}, "image: expected the name of a field, found 1"),
        ({"clouds": "a.csv"}, "clouds: expected a list, found str"),
    ],
)
def test_values_of_other_types_are_refused_with_their_path(fields: dict[str, object], message: str) -> None:
    with pytest.raises((TypeError, ValueError)) as caught:
        ball(**fields)
    assert str(caught.value).startswith(message)


def test_files_are_missed() -> None:
    with pytest.raises((OSError, marbles.SceneError)):
        marbles.load("there_is_no_such_scene.ron")


def test_warnings_point_at_the_caller() -> None:
    with pytest.warns(marbles.SceneWarning, match="unused") as caught:
        scene = ball(materials={"candy": {}, "unused": {}})
    assert caught[0].filename == str(Path(__file__).with_name("conftest.py"))
    with pytest.warns(marbles.SceneWarning) as caught:
        scene.replace(materials={"candy": {}, "other": {}})
    assert caught[0].filename == __file__
    assert any("unused" in text for text in scene.warnings)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        ball()


def test_soft_light_is_saved_and_loaded(tmp_path: Path) -> None:
    sky = marbles.Sky(above=(0.2, 0.3, 0.5), below="tan", up=(0, 1, 0.5))
    scene = ball(lights=[marbles.Directional((-1, 1, -1), diameter=0.53)], sky=sky)
    assert "diameter: 0.53" in scene.text and "sky: Sky(above: (0.2, 0.3, 0.5)" in scene.text
    scene.save(tmp_path / "a.ron")
    read = marbles.load(tmp_path / "a.ron")
    assert same(read.render(samples=1).light, scene.render(samples=1).light)
    as_dicts = scene.replace(
        lights=[{"Directional": {"toward": [-1, 1, -1], "diameter": 0.53}}],
        sky={"above": (0.2, 0.3, 0.5), "below": "tan", "up": (0, 1, 0.5)},
    )
    assert same(as_dicts.render(samples=1).light, scene.render(samples=1).light)
    refused: list[tuple[dict[str, object], str]] = [
        ({"sky": marbles.Sky(above=1, below=(0, -1, 0))}, "sky.below[1]"),
        ({"sky": marbles.Sky(above=1, below=0, up=(0, 0, 0))}, "sky.up"),
        ({"sky": -1}, "sky"),
        ({"lights": [marbles.Directional((0, 1, 0), diameter=180)]}, "lights[0].diameter"),
    ]
    for field, path in refused:
        with pytest.raises(marbles.SceneError) as caught:
            ball(**field)
        assert caught.value.path == path


def test_fields_are_replaced() -> None:
    scene = marbles.loads(TEXT)
    brighter = scene.replace(ambient=1, background="#808080")
    assert scene.text == TEXT
    assert "// small" in brighter.text
    assert brighter.render(1e-2).light.max() > scene.render(1e-2).light.max()
    back = brighter.replace(background=None, ambient=0.5)
    assert same(back.render(1e-2).light, scene.render(1e-2).light)
    moving = scene.replace(camera=marbles.Frame(), animation=marbles.Turntable(4))
    assert moving.frame_range == (1, 4)
    assert moving.replace(animation=None).frame_range is None
    with pytest.raises(marbles.SceneError):
        scene.replace(colour=1)


def test_fields_that_are_taken_out_leave_nothing() -> None:
    scene = marbles.loads(TEXT)
    assert scene.replace(zoom=2).text == TEXT.replace("],\n)", "],\n    zoom: 2\n)")
    assert scene.replace(zoom=2).replace(zoom=None).text == TEXT
    assert scene.replace(ambient=None).text == TEXT.replace("    ambient: 0.5,\n", "")
    array = marbles.Spheres([(0, 0, 0)], color="red")
    once = ball(spheres=[array, {"center": (2, 0, 0), "radius": 1, "material": "candy"}])
    assert once.replace(spheres=[array, {"center": (2, 0, 0), "radius": 1, "material": "candy"}]).text == once.text


def test_arrays_are_replaced() -> None:
    one = marbles.Spheres([(0, 0, 0)], 1, color=(1, 0, 0))
    two = marbles.Spheres([(0, 0, 0), (2, 0, 0)], [1, 0.5])
    scene = marbles.loads(TEXT).replace(spheres=one)
    assert len(scene.spheres_table()["x"]) == 1
    other = scene.replace(spheres=two)
    assert len(other.spheres_table()["x"]) == 2
    assert other.materials == []
    assert same(other.render(1e-2).light, marbles.loads(TEXT).render(1e-2).light)
    both = scene.replace(spheres=[one, two, {"center": (-2, 0, 0), "radius": 0.2}])
    assert len(both.spheres_table()["x"]) == 4
    assert len(both.replace(camera=marbles.Free(position=(0, 0, -9))).spheres_table()["x"]) == 4
    assert both.replace(spheres=[]).spheres_table()["x"].shape == (0,)


def test_a_table_of_spheres_is_flat() -> None:
    scene = ball()
    table = marbles.spheres(scene)
    assert list(table) == ["x", "y", "z", "radius", "red", "green", "blue", "material"]
    assert table["y"].tolist() == [-1000, 1] and table["radius"].tolist() == [1000, 1]
    assert table["material"].tolist() == ["", "candy"]
    assert table["green"][0] == 1 and table["red"][1] > table["green"][1]
    assert all(column.flags.c_contiguous and column.shape == (2,) for column in table.values())
    helix = marbles.load(ROOT / "scenes" / "orbits.ron")
    assert len(helix.spheres_table()["x"]) == 90
    assert not same(helix.spheres_table(1)["x"], helix.spheres_table(2)["x"])


def test_variants_are_values() -> None:
    light = marbles.Directional((1, 2, 3), name="a")
    assert light == marbles.Directional(np.array([1, 2, 3]), name="a") != marbles.Directional([1, 2, 4], name="a")
    assert repr(marbles.LookAt((0, 0, 1), (0, 0, 0))) == "LookAt(position=(0, 0, 1), target=(0, 0, 0))"
    assert copy.deepcopy(light) == pickle.loads(pickle.dumps(light)) == light
    with pytest.raises(AttributeError):
        light.name = "b"
    with pytest.raises(TypeError):
        marbles.Directional()  # type: ignore[call-arg]
    with pytest.raises(TypeError, match="Power: expected"):
        marbles.Power()
