"""A picture beside a map of its claimed errors.

Needs numpy and matplotlib. Writes error_map.png, or the file named on the command line. Without matplotlib, it only
prints numbers.
"""

from __future__ import annotations

import sys
from dataclasses import dataclass
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path

import marbles
import numpy as np

TOLERANCE = 1e-3


@dataclass(frozen=True)
class Result:
    largest: float
    """The largest error of any pixel."""
    median: float
    bounds: float
    """The share of pixels whose error is a proved bound."""
    over: int


def scene() -> marbles.Scene:
    return marbles.Scene(
        image={"width": 300, "height": 240},
        lens=marbles.Fov(30),
        camera=marbles.LookAt(position=(0, 2.5, -9), target=(0, 0.8, 0)),
        background=0.05,
        ambient=0.08,
        lights=[marbles.Directional((-1, 1, -1), 0.9)],
        materials={
            "red": {"albedo": (0.9, 0.2, 0.15), "highlight": {"strength": 0.4, "shininess": 30}},
            "snow": {"rough": {"amplitude": 0.25, "grain": marbles.Surface(0.08)}},
        },
        spheres=[
            {"center": (0, -200, 0), "radius": 200},
            {"center": (-0.9, 1, 0), "radius": 1, "material": "red"},
            {"center": (1.2, 0.7, -0.4), "radius": 0.7, "material": "snow"},
            {"center": (-0.1, 0.3, -1.6), "radius": 0.3},
        ],
    )


def draw(picture: marbles.Picture, path: Path) -> None:
    # A figure without pyplot, which needs no window.
    figure = import_module("matplotlib.figure").Figure(figsize=(12, 3.3), layout="constrained")
    logarithmic = import_module("matplotlib.colors").LogNorm(1e-4 * TOLERANCE, TOLERANCE)
    left, middle, right = figure.subplots(1, 3)
    left.imshow(picture.to_srgb())
    left.set_title("picture")
    # Some errors are zero or nearly so: the colors begin at a ten-thousandth of the tolerance.
    shown = middle.imshow(np.maximum(picture.error, 1e-4 * TOLERANCE), norm=logarithmic, cmap="viridis")
    middle.set_title("claimed error")
    figure.colorbar(shown, ax=middle)
    right.imshow(picture.bound, cmap="coolwarm_r", vmin=0, vmax=1)
    right.set_title("blue: proved bounds; red: estimates")
    for axes in (left, middle, right):
        axes.set_axis_off()
    figure.savefig(path, dpi=100)


def main(path: Path = Path("error_map.png")) -> Result:
    picture = scene().render(TOLERANCE)
    result = Result(
        largest=picture.largest_error,
        median=float(np.median(picture.error)),
        bounds=float(picture.bound.mean()),
        over=picture.over,
    )
    print(f"error <= {result.largest:.1e} (median {result.median:.1e}), {result.over} pixels over the tolerance")
    print(f"{100 * result.bounds:.0f} % of the errors are proved bounds, the others are estimates")
    if find_spec("matplotlib"):
        draw(picture, path)
        print(f"picture and errors are in {path}")
    else:
        print("matplotlib is not installed: no map is drawn")
    return result


if __name__ == "__main__":
    main(*map(Path, sys.argv[1:]))
