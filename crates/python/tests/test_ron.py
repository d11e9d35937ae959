"""The writer of RON."""

from __future__ import annotations

from pathlib import Path

import marbles
import numpy as np
import pytest
from marbles.ron import quote, read_string, write, write_scene
from marbles.variant import Value, Variant


@pytest.mark.parametrize(
    ("value", "field", "text"),
    [
        (1, "", "1"),
        (0.1, "", "0.1"),
        (1e22, "", "1e+22"),
        (-0.0, "", "-0.0"),
        (np.float32(0.5), "", "0.5"),
        (np.int64(7), "", "7"),
        (np.bool_(True), "", "true"),
        (False, "", "false"),
        ((0, 1.5, 2), "center", "(0, 1.5, 2)"),
        ([0, 1, 2], "center", "(0, 1, 2)"),
        (np.array([0.5, 1]), "center", "(0.5, 1.0)"),
        (np.arange(6)[::2], "center", "(0, 2, 4)"),
        (range(2), "frames", "(0, 1)"),
        (np.eye(3, dtype=int), "rotation", "[(1, 0, 0), (0, 1, 0), (0, 0, 1)]"),
        ("red", "color", '"red"'),
        ("Element", "color", "Element"),
        ("Element", "name", '"Element"'),
        ("None", "falloff", "None"),
        ("Not a name", "color", '"Not a name"'),
        (Path("a/b.csv"), "file", '"a/b.csv"'),
        ({"width": 3, "height": None}, "image", "(width: 3)"),
        ({"A b": {"albedo": 1}, "c": None}, "materials", '{"A b": (albedo: 1)}'),
        ({"O": 1.2, 3: 0.5}, "radii", '{"O": 1.2, "3": 0.5}'),
        ({"Fov": 40}, "lens", "Fov(40)"),
        ({"Percentile": [1, 99]}, "range", "Percentile(1, 99)"),
        ({"Free": {}}, "camera", "Free()"),
        ({"radius": {"Power": {"column": "m"}}}, "columns", '(radius: Power(column: "m"))'),
        (marbles.Free(), "camera", "Free()"),
        (marbles.Fov(40), "lens", "Fov(40)"),
        (Variant("Pixel"), "grain", "Pixel"),
        (marbles.Length("vx", "vy", 0.0), "value", 'Length("vx", "vy", 0.0)'),
        ([("type", marbles.Is(2))], "keep", '[("type", Is(2))]'),
        (marbles.Keyframes([{"frame": 1, "ease": "Linear"}]), "animation", "Keyframes(keys: [(frame: 1, ease: Linear)])"),
        (marbles.Point((0, 1, 2), falloff="None"), "", "Point(position: (0, 1, 2), falloff: None)"),
        (marbles.Directional((0, 1, 0), diameter=0.53), "", "Directional(toward: (0, 1, 0), diameter: 0.53)"),
        (marbles.Sky(0.5, "tan"), "sky", 'Sky(above: 0.5, below: "tan")'),
        (marbles.Sky(above=0.5, below=(0, 0, 1), up=(0, 0, 1)), "sky", "Sky(above: 0.5, below: (0, 0, 1), up: (0, 0, 1))"),
        ({"above": 0.5, "below": 0.25}, "sky", "(above: 0.5, below: 0.25)"),
        (np.array([160, 192, 255], np.uint8), "sky", '"#a0c0ff"'),
        (marbles.Power(column="m", offset=1), "radius", 'Power(column: "m", offset: 1)'),
        ('a "b" \\ \n\x00é', "name", '"a \\"b\\" \\\\ \\n\\u{0}é"'),
    ],
)
def test_values_are_written(value: Value, field: str, text: str) -> None:
    assert write(value, field) == text


@pytest.mark.parametrize(
    ("value", "error", "message"),
    [
        (object(), TypeError, "a: expected a number, "),
        (1j, TypeError, "a: expected a number, "),
        (b"b", TypeError, "a: expected a number, "),
        ({1}, TypeError, "a: expected a number, "),
        (None, TypeError, "a: expected a number, "),
        ([1, [2, None]], TypeError, "a[1][1]: expected a number, "),
        ({"b": [{}, {"c": 1j}]}, TypeError, "a.b[1].c: expected a number, "),
        (np.array([1j]), TypeError, "a: expected numbers or texts, found complex128"),
        (np.array(["2020-01-01"], "M8[D]"), TypeError, "a: expected numbers or texts, found "),
        (float("inf"), ValueError, "a: expected a finite number, found inf"),
        (np.array([0, np.nan]), ValueError, "a[1]: expected a finite number, found nan"),
        (10**30, ValueError, "a: expected a whole number of at most 64 bits"),
        ("\ud800", ValueError, "a: expected a text in Unicode"),
        ({"a b": 1}, TypeError, "a: expected the name of a field, found 'a b'"),
        (marbles.Fov(float("nan")), ValueError, "a[0]: expected a finite number, found nan"),
        ({"Fov": float("nan")}, ValueError, "a[0]: expected a finite number, found nan"),
        ({"Percentile": [1, None]}, TypeError, "a[1]: expected a number, "),
        ({"Fov": 1, "x": 2}, TypeError, "a: expected nothing beside 'Fov'"),
        (Variant("fov", 1), TypeError, "a: expected a name that begins with a capital letter"),
    ],
)
def test_other_values_are_refused(value: Value, error: type[Exception], message: str) -> None:
    with pytest.raises(error) as caught:
        write(value, "a")
    assert str(caught.value).startswith(message)


def test_endless_values_are_refused() -> None:
    endless: list[object] = []
    endless.append(endless)
    with pytest.raises(ValueError, match="expected at most 32 levels"):
        write(endless, "a")


@pytest.mark.filterwarnings("ignore::marbles.SceneWarning")
def test_floats_read_back_the_same() -> None:
    random = np.random.default_rng(5)
    numbers = random.standard_normal(100) * 10.0 ** random.integers(-30, 30, 100)
    spheres = [{"center": (x, 0, 0), "radius": abs(x)} for x in numbers.tolist()]
    text = write_scene({"image": {"width": 4, "height": 4}, "lens": marbles.Fov(40), "camera": marbles.Free(), "ambient": 1, "spheres": spheres})  # fmt: skip
    table = marbles.loads(text).spheres_table()
    assert table["x"].tolist() == numbers.tolist()


@pytest.mark.filterwarnings("ignore::marbles.SceneWarning")
def test_names_read_back_the_same() -> None:
    name = 'a "b" \\ \té\x01 {}'
    fields: dict[str, Value] = {"materials": {name: {}}, "spheres": [{"center": (0, 0, 9), "radius": 1, "material": name}]}
    scene = marbles.loads(
        write_scene({"image": {"width": 4, "height": 4}, "lens": marbles.Fov(40), "camera": marbles.Free(), "ambient": 1, **fields})  # fmt: skip
    )
    assert scene.materials == [name]


def test_long_lists_have_lines() -> None:
    text = write_scene({"spheres": [{"center": (0.125, 0.25, 0.5), "radius": 1.0}] * 3, "zoom": 2, "unit": None})
    assert text.count("\n") == 8 and "\n        (center: (0.125, 0.25, 0.5), radius: 1.0),\n" in text


@pytest.mark.parametrize("text", ["", "a", 'b "c"', "d\\e\n", "\\", '\\"', "é/x.csv"])
def test_strings_are_read(text: str) -> None:
    assert read_string(quote(text)) == text
    assert read_string(f'r##"{text}"##') == text


def test_other_texts_are_no_strings() -> None:
    for text in ("", '"', "Fov(1)", '"a\\u{e9}"', "12"):
        assert read_string(text) is None
