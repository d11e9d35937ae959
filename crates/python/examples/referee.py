"""marbles as a referee of Mitsuba: hands a scene over, and explains the differences by what both know of their errors.

Needs numpy and mitsuba; says so if mitsuba cannot be imported. Prints a few lines.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from importlib import import_module
from importlib.util import find_spec
from typing import Any

import marbles
import numpy as np
from numpy.typing import NDArray

TOWARD = (-1.0, 2.0, -1.5)
RUNS, SAMPLES = 16, 64  # of Mitsuba: 16 pictures with 64 samples per pixel each
SINGLE = 1e-5  # for Mitsuba's single precision


@dataclass(frozen=True)
class Result:
    pixels: int
    rms: float
    noise: float
    """The RMS of the standard deviations of Mitsuba's pixels, from its own runs."""
    mean: float
    """The difference of the mean light of all pixels."""
    beyond: int
    """The number of pixels that differ by more than the claim and three standard deviations."""
    beyond_darker: int
    """The same for a picture that is one percent too dark, to show what the referee notices."""


def scene() -> marbles.Scene:
    random = np.random.default_rng(seed=5)
    heap = marbles.Spheres(
        center=random.uniform((-2.2, 0.3, -1.5), (2.2, 2.2, 2), size=(60, 3)),
        radius=random.uniform(0.12, 0.4, 60),
        color=random.uniform(0.1, 1, size=(60, 3)),
    )
    return marbles.Scene(
        image={"width": 96, "height": 72},
        lens=marbles.Fov(35),
        camera=marbles.LookAt(position=(1, 2.5, -9), target=(0, 1, 0)),
        lights=[marbles.Directional(TOWARD)],
        spheres=[{"center": (0, -50, 0), "radius": 50}, heap],
    )


def handed_over(mitsuba: Any, scene: marbles.Scene) -> dict[str, Any]:
    """The scene for Mitsuba, in the right-handed world of the camera: z is negated."""
    camera, (width, height) = scene.camera(), scene.size
    assert camera.K is not None
    # Mitsuba's camera has x left and y up, OpenCV's x right and y down.
    to_world = np.eye(4)
    to_world[:3, :3], to_world[:3, 3] = camera.R.T * (-1, -1, 1), camera.position
    x, y, z = TOWARD
    world: dict[str, Any] = {
        "type": "scene",
        "integrator": {"type": "direct", "emitter_samples": 1, "bsdf_samples": 0},
        "sensor": {
            "type": "perspective",
            "fov": math.degrees(2 * math.atan(width / 2 / camera.K[0, 0])),
            "fov_axis": "x",
            "to_world": mitsuba.ScalarTransform4f(to_world),
            "sampler": {"type": "independent"},
            "film": {
                "type": "hdrfilm", "width": width, "height": height, "pixel_format": "rgb",
                "component_format": "float32", "rfilter": {"type": "box"},
            },
        },
        # In marbles a white surface that faces a light of intensity 1 has the radiance 1; it reflects 1/π of the light
        # into a direction.
        "light": {"type": "directional", "direction": [-x, -y, z], "irradiance": {"type": "rgb", "value": math.pi}},
    }  # fmt: skip
    table = scene.spheres_table()
    columns = zip(*(table[name].tolist() for name in ("x", "y", "z", "radius", "red", "green", "blue")))
    for index, (x, y, z, radius, *albedo) in enumerate(columns):
        bsdf = {"type": "diffuse", "reflectance": {"type": "rgb", "value": albedo}}
        world[f"sphere{index}"] = {"type": "sphere", "center": [x, y, -z], "radius": radius, "bsdf": bsdf}
    return world


def main() -> Result | None:
    if find_spec("mitsuba") is None:
        print("mitsuba is not installed: nothing to referee")
        return None
    mitsuba: Any = import_module("mitsuba")
    mitsuba.set_variant("scalar_rgb")
    ours = scene()
    theirs = mitsuba.load_dict(handed_over(mitsuba, ours))
    runs = np.array([np.array(mitsuba.render(theirs, spp=SAMPLES, seed=seed), float) for seed in range(RUNS)])
    found, deviation = runs.mean(axis=0), runs.std(axis=0, ddof=1) / math.sqrt(RUNS)
    picture = ours.render(1e-4)

    def beyond(light: NDArray[np.float64]) -> int:
        # All runs agree where no sample hits a small part of a pixel. N samples easily miss a share of 3 / N.
        allowed = picture.error[..., None] + 3 * deviation + SINGLE + 3 / (RUNS * SAMPLES)
        return int(np.count_nonzero((np.abs(light - found) > allowed).any(axis=-1)))

    result = Result(
        pixels=picture.error.size,
        rms=marbles.compare(picture, found).rms,
        noise=float(np.sqrt(np.mean(deviation**2))),
        mean=float(abs((picture.light - found).mean())),
        beyond=beyond(picture.light),
        beyond_darker=beyond(0.99 * picture.light),
    )
    print(f"RMS difference {result.rms:.1e}, noise of Mitsuba {result.noise:.1e}, means differ by {result.mean:.1e}")
    print(f"{result.beyond} of {result.pixels} pixels differ by more than the claim and three standard deviations")
    print(f"of a picture that is one percent darker, it would be {result.beyond_darker}")
    return result


if __name__ == "__main__":
    main()
