"""Arrays of spheres."""

from __future__ import annotations

import io
import pickle
import time
from typing import Any

import marbles
import numpy as np
import pytest
from conftest import ball, same

# The material of the ball is not used by all of these spheres.
pytestmark = pytest.mark.filterwarnings("ignore::marbles.SceneWarning")

CENTERS = np.array([[0.0, 1, 0], [2, 0.5, 0], [-2, 0.5, 0.25]])


def table(spheres: marbles.Spheres) -> Any:
    """The records of the NPY file."""
    return np.load(io.BytesIO(spheres.npy()))


def test_the_table_has_the_records() -> None:
    records = table(marbles.Spheres(CENTERS, [1, 2, 3], color=np.zeros((3, 3), np.uint8)))
    assert records.dtype.descr == [("pos", "<f8", (3,)), ("radius", "<f8"), ("color", "|u1", (3,))]
    assert records["pos"].tolist() == CENTERS.tolist() and records["radius"].tolist() == [1, 2, 3]
    records = table(marbles.Spheres(CENTERS.astype(np.float32), 2, value=np.arange(3, dtype=">f4")))
    assert records.dtype.descr == [("pos", "<f4", (3,)), ("value", "<f4")]
    assert len(table(marbles.Spheres(np.empty((0, 3))))) == 0


@pytest.mark.parametrize(
    "centers",
    [
        CENTERS.tolist(),
        CENTERS.astype(">f8"),
        np.asfortranarray(CENTERS),
        np.repeat(CENTERS, 2, axis=0)[::2],
        CENTERS[::-1][::-1],
        CENTERS.astype(np.float32),
        CENTERS.astype(np.longdouble),
        np.frombuffer(CENTERS.tobytes()).reshape(3, 3),
    ],
)
def test_arrays_of_all_kinds_are_the_same_spheres(centers: Any) -> None:
    found = ball(spheres=marbles.Spheres(centers, [1, 0.5, 0.5])).spheres_table()
    assert [found["x"].tolist(), found["y"].tolist(), found["z"].tolist()] == CENTERS.T.tolist()
    assert found["radius"].tolist() == [1, 0.5, 0.5]


def test_an_array_renders_as_single_spheres_do() -> None:
    items = [{"center": center, "radius": 0.5, "material": "candy"} for center in CENTERS]
    array = marbles.Spheres(CENTERS, 0.5, material="candy")
    one, other = ball(spheres=items).render(channels=["id"]), ball(spheres=array).render(channels=["id"])
    assert same(one.light, other.light) and same(one["id"], other["id"])
    assert same(ball(spheres=marbles.Spheres(CENTERS, [0.5] * 3, material="candy")).render().light, one.light)


def test_changes_of_an_array_do_not_reach_the_scene() -> None:
    centers = CENTERS.copy()
    scene = ball(spheres=marbles.Spheres(centers, 0.5))
    before = scene.render(1e-2).light
    centers[:] = 0
    assert same(scene.render(1e-2).light, before)
    spheres = marbles.Spheres(centers)
    with pytest.raises(AttributeError):
        spheres.color = 1  # type: ignore[misc]
    with pytest.raises(ValueError):
        spheres.records["pos"] = 1


def test_colors() -> None:
    def colors(**given: Any) -> Any:
        found = ball(spheres=marbles.Spheres(CENTERS, 0.5, **given)).spheres_table()
        return np.stack([found["red"], found["green"], found["blue"]], 1).tolist()

    assert colors() == [[1, 1, 1]] * 3
    assert colors(color=(0.25, 0.5, 1)) == [[0.25, 0.5, 1]] * 3
    assert colors(color=0.5) == [[0.5] * 3] * 3
    assert colors(color="#ff0000") == colors(color=np.array([255, 0, 0], np.uint8)) == [[1, 0, 0]] * 3
    assert colors(color=np.eye(3) * 0.5) == (np.eye(3) * 0.5).tolist()
    assert colors(color=np.eye(3, dtype=np.uint8) * 255) == np.eye(3).tolist()
    grey = colors(value=[0, 5, 10], colormap="Grey")
    assert grey[0] == [0, 0, 0] and grey[2] == [1, 1, 1]
    assert len(colors(value=[0, np.nan, 10], missing="Hide")) == 2
    assert colors(value=[1, 2, 1], color="Category")[0] == colors(value=[1, 2, 1], color="Category")[2]


def test_one_color_keeps_the_rest_of_a_material() -> None:
    scene = ball(spheres=[marbles.Spheres(CENTERS, 0.5, color="gold", material="candy"), {"center": (0, 3, 0), "radius": 0.1, "material": "candy"}])  # fmt: skip
    assert scene.materials == ["candy", "spheres"]
    assert 'highlight: (strength: 0.6, shininess: 10), albedo: "gold"' in scene.text or 'albedo: "gold", highlight' in scene.text


def test_options_pass_through() -> None:
    spheres = marbles.Spheres(CENTERS, 0.5, scale=2, position=(1, 2, 3), right_handed=True)
    found = ball(spheres=spheres).spheres_table()
    assert found["radius"].tolist() == [1, 1, 1]
    assert found["z"].tolist() == [3, 3, 2.5] and found["x"].tolist() == [1, 5, -3]


@pytest.mark.parametrize(
    ("given", "error", "message"),
    [
        ({"radius": -1.0}, ValueError, "spheres.radius: expected a radius greater than 0, found -1.0"),
        ({"radius": [1, 1, 0]}, ValueError, "spheres.radius[2]: expected a radius greater than 0, found 0.0"),
        ({"radius": [1, 2]}, ValueError, "spheres.radius: expected an array of the shape (3,), found (2,)"),
        ({"radius": np.ones((3, 1))}, ValueError, "spheres.radius: expected an array of the shape (3,), found (3, 1)"),
        ({"radius": True}, TypeError, "spheres.radius: expected real numbers"),
        ({"radius": np.inf}, ValueError, "spheres.radius: expected a finite number, found inf"),
        ({"center": [[0, 0, np.nan]]}, ValueError, "spheres.center[0, 2]: expected a finite number, found nan"),
        ({"center": [0, 0, 0]}, ValueError, "spheres.center: expected an array of the shape (n, 3), found (3,)"),
        ({"center": [[0, 0], [1]]}, ValueError, "spheres.center: expected numbers of the shape (n, 3), found list"),
        ({"center": "abc"}, TypeError, "spheres.center: expected real numbers of the shape (n, 3), found texts"),
        ({"center": CENTERS.astype(object)}, TypeError, "spheres.center: expected real numbers"),
        ({"center": CENTERS * 1j}, TypeError, "spheres.center: expected real numbers"),
        ({"center": [[10**400, 0, 0]]}, TypeError, "spheres.center: expected real numbers"),
        ({"color": [[1, 1, 1], [0, -0.5, 0], [1, 1, 1]]}, ValueError, "spheres.color[1, 1]: expected a color of at least 0"),
        ({"color": [1, 1]}, ValueError, "spheres.color: expected an array of the shape (3, 3), found (2,)"),
        ({"color": np.ones((3, 4))}, ValueError, "spheres.color: expected an array of the shape (3, 3), found (3, 4)"),
        ({"value": [1, np.nan, 2]}, ValueError, "spheres.value[1]: expected a finite number, found nan"),
        ({"value": [1, 2, 3], "color": np.ones((3, 3))}, ValueError, "spheres.value: expected either"),
        ({"colour": 1}, TypeError, "spheres.colour: expected one of the fields"),
        ({"material": 1}, TypeError, "spheres.material: expected the name of a material, found int"),
    ],
)
def test_wrong_arrays_are_refused_with_their_place(given: dict[str, object], error: type[Exception], message: str) -> None:
    with pytest.raises(error) as caught:
        marbles.Spheres(**({"center": CENTERS} | given))  # type: ignore[arg-type]
    assert str(caught.value).startswith(message)


def test_a_million_spheres_are_quick() -> None:
    random = np.random.default_rng(1)
    centers, radii, colors = random.random((10**6, 3)), 0.1 + random.random(10**6), random.random((10**6, 3))
    start = time.perf_counter()
    spheres = marbles.Spheres(centers, radii, colors)
    contents = spheres.npy()
    assert time.perf_counter() - start < 2  # a fifth of a second on a machine at rest
    assert len(contents) - 56 * 10**6 in range(64, 1024)
    assert len(spheres) == 10**6 and "1000000" in repr(spheres)


def test_copies_are_the_same() -> None:
    spheres = marbles.Spheres(CENTERS, 0.5, color="red", scale=2)
    other = pickle.loads(pickle.dumps(spheres))
    assert other.npy() == spheres.npy() and other.cloud("a") == spheres.cloud("a")
    assert not other.records.flags.writeable
