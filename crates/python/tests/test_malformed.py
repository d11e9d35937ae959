"""Ten thousand scenes and arrays with faults: each is refused as a ValueError or a TypeError, or is none."""

from __future__ import annotations

import random
import re
import warnings
from collections.abc import Callable

import marbles
import numpy as np
import pytest
from conftest import ROOT
from marbles.ron import write

WRONG: list[object] = [
    None, -1, 0, 1e400, float("nan"), 10**30, 2**63, "", "red", "Red", "\ud800", b"x", 1j, object(), [], (), {}, [1], (1, 2),
    {"a": 1}, {"Fov": 3}, {1: 2}, np.zeros(2), np.zeros((2, 2)), np.array(3), np.array(["a"]), True, marbles.Fov(3),
    marbles.Variant("Nope", 1, 2), marbles.Spheres([(0, 0, 0)]), [None], [[[]]], {"": 0}, range(3), Exception, "\x00",
]  # fmt: skip
TEXT = (ROOT / "scenes" / "first.ron").read_text(encoding="utf-8")
PATH = re.compile(r"^[a-z_]+[\w.\[\]\", ]*: ")


def refused(make: Callable[[], object]) -> str | None:
    """The message with which something is refused; None if it is not. Other errors are failures of the test."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            make()
    except (ValueError, TypeError) as error:
        return str(error)
    return None


def fields() -> dict[str, object]:
    """The fields of a scene without faults."""
    return {
        "image": {"width": 8, "height": 8},
        "lens": {"Fov": 40},
        "camera": {"LookAt": {"position": [0, 0, -9], "target": [0, 0, 0], "roll": 0}},
        "zoom": 1,
        "background": 0,
        "ambient": 0.1,
        "lights": [{"Directional": {"toward": [1, 1, -1], "intensity": 1}}, {"Point": {"position": [2, 2, -2]}}],
        "materials": {"m": {"albedo": [1, 0.5, 0], "highlight": {"shininess": 4}}},
        "spheres": [{"center": [0, 0, 0], "radius": 1, "material": "m"}, {"center": [2, 0, 0], "radius": 0.5}],
        "animation": {"Turntable": {"frames": 3, "what": "Lights"}},
    }


def places(value: object) -> list[tuple[object, object]]:
    """Every container of a value together with a key or an index in it."""
    found: list[tuple[object, object]] = []
    items = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    for key, item in items:
        found += [(value, key), *places(item)]
    return found


def test_wrong_values_in_scenes() -> None:
    dice = random.Random(1)
    assert refused(lambda: marbles.Scene(**fields())) is None  # type: ignore[arg-type]
    told = 0
    for _ in range(3000):
        values = fields()
        container, key = dice.choice(places(values))
        if dice.random() < 0.2 and isinstance(container, dict):
            container[dice.choice(["colour", "Radius", "x y", 3, ""])] = container.pop(key)
        else:
            container[key] = dice.choice(WRONG)  # type: ignore[index]
        message = refused(lambda values=values: marbles.Scene(**values))  # type: ignore[misc]
        told += message is not None and PATH.match(message) is not None
    assert told > 2000


def test_wrong_arrays() -> None:
    dice, numbers = random.Random(2), np.random.default_rng(2)

    def array() -> object:
        shape = dice.choice([(), (0,), (3,), (5,), (5, 3), (5, 2), (4, 3), (0, 3), (5, 3, 1), (1, 5, 3)])
        made = numbers.uniform(0.1, 1, shape)
        kind = dice.choice(["<f8", ">f8", "<f4", "<f2", "i8", "u1", "O", "c16", "?", "U3", "S3", "M8[s]", "V8"])
        with np.errstate(all="ignore"):
            made = made.astype("i8").astype(kind) if kind in ("M8[s]", "V8") else made.astype(kind)
        if made.dtype.kind == "f" and made.size and dice.random() < 0.4:
            made.flat[dice.randrange(made.size)] = dice.choice([np.nan, np.inf, -np.inf, -1, 0])
        if dice.random() < 0.2:
            made = made[::-1] if made.ndim else made
        if dice.random() < 0.2:
            made.flags.writeable = False
        return dice.choice([made, made, made.tolist(), np.asfortranarray(made), dice.choice(WRONG)])

    told = 0
    for _ in range(5000):
        given: dict[str, object] = {"center": numbers.uniform(-1, 1, (5, 3)), "radius": 0.5}
        for name in dice.sample(["center", "radius", "color", "value", "material", "scale", "colormap", "nope"], 2):
            given[name] = dice.choice([array(), array(), dice.choice(WRONG)])
        message = refused(lambda given=given: marbles.Spheres(**given))  # type: ignore[misc]
        if message is not None:
            told += 1
            assert message.startswith("spheres."), message
    assert told > 3000


def test_broken_texts() -> None:
    dice = random.Random(3)
    told = 0
    for _ in range(1500):
        start = dice.randrange(len(TEXT))
        kind = dice.randrange(4)
        text = (
            TEXT[:start]
            if kind == 0
            else TEXT[:start] + TEXT[start + dice.randrange(1, 9) :]
            if kind == 1
            else TEXT[:start] + dice.choice(["(", ")", "[", '"', ":", ",", "é", "\x00", "-", "None", "{}"]) + TEXT[start:]
            if kind == 2
            else "{" + TEXT[start:]
        )
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")
                marbles.loads(text)
        except marbles.SceneError as error:
            told += 1
            assert error.faults or str(error)
            assert error.line is None or error.line >= 1
            assert error.column is None or error.column >= 1
    assert told > 700


@pytest.mark.filterwarnings("ignore::marbles.SceneWarning")
def test_wrong_values_in_changes() -> None:
    dice = random.Random(4)
    scene = marbles.loads(TEXT)
    names = [*fields(), "clouds", "unit", "shadows", "nope", "spheres[0]", "lens.x", ""]
    told = 0
    for _ in range(500):
        given = {dice.choice(names): dice.choice(WRONG) for _ in range(dice.randrange(1, 3))}
        told += refused(lambda given=given: scene.replace(**given)) is not None  # type: ignore[misc]
    assert told > 300
    assert scene.text == TEXT


def test_wrong_values_for_the_writer() -> None:
    for value in WRONG:
        for field in ("", "materials", "lights", "color", "radii"):
            refused(lambda value=value, field=field: write(value, field, "a"))  # type: ignore[misc]
