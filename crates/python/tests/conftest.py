"""What several tests use."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path
from typing import Any

import marbles
import numpy as np
import pytest
from numpy.typing import NDArray

ROOT = Path(__file__).resolve().parents[3]
SCENES = sorted((ROOT / "scenes").rglob("*.ron"))


def command(*arguments: object) -> str:
    """Runs the command in a process of its own; pixels over the tolerance are no failure. Returns its stdout."""
    line = [sys.executable, "-m", "marbles", *map(str, arguments)]
    done = subprocess.run(line, capture_output=True, text=True, timeout=300, check=False)
    assert done.returncode in (0, 3), done.stderr
    return done.stdout


def ball(**fields: object) -> marbles.Scene:
    """A ball on a floor, in 48 x 32 pixels, with other values in some fields."""
    values: dict[str, object] = {
        "image": {"width": 48, "height": 32},
        "lens": marbles.Fov(40),
        "camera": marbles.LookAt(position=(0, 3, -10), target=(0, 0.7, 0)),
        "ambient": 0.1,
        "lights": [marbles.Directional(toward=(-1, 1.5, -1), name="sun")],
        "materials": {"candy": {"albedo": "#d02840", "highlight": {"strength": 0.6, "shininess": 10}}},
        "spheres": [
            {"center": (0, -1000, 0), "radius": 1000},
            {"center": (0, 1, 0), "radius": 1, "material": "candy"},
        ],
    }
    return marbles.Scene(**(values | fields))  # type: ignore[arg-type]


def same(a: NDArray[Any], b: NDArray[Any]) -> bool:
    """Whether two arrays are the same bit for bit."""
    return a.shape == b.shape and a.dtype == b.dtype and a.tobytes() == b.tobytes()


@pytest.fixture
def turning() -> marbles.Scene:
    """The ball with a camera that goes around it in six frames."""
    return ball(camera=marbles.Orbit(target=(0, 0.7, 0), radius=10, elevation=15), animation=marbles.Turntable(frames=6))
