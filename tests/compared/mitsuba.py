"""Mitsuba 3, compiled by LLVM for the processor: direct light, the box filter."""

import math
from pathlib import Path

import numpy as np

from compared.program import Clock, Method, Program, Rendered
from compared.scenes import Scene

VARIANT = "llvm_ad_rgb"
SAMPLES = [1, 4, 16, 64, 256, 1024, 4096]
STRATIFIED = Method(
    "Mitsuba, multijitter",
    f"mi.render(scene, spp=N) in drjit.freeze; {VARIANT}, direct, box, multijitter",
    SAMPLES,
    SAMPLES,
    [str(samples) for samples in SAMPLES],
)


class Mitsuba(Program):
    name = "Mitsuba"
    methods = [STRATIFIED]

    def __init__(self):
        import drjit
        import mitsuba

        mitsuba.set_variant(VARIANT)
        drjit.set_thread_count(1)
        self.library, self.version, self.loaded = mitsuba, mitsuba.__version__, (None, None)
        self.drjit, self.warm = drjit, set()

        @drjit.freeze
        def render(scene, seed, samples):
            return mitsuba.render(scene, spp=samples, seed=seed)

        self.frozen = render

    @staticmethod
    def find() -> "Mitsuba | None":
        try:
            return Mitsuba()
        except ImportError:
            return None

    def render(self, scene: Scene, method: Method, setting, folder: Path) -> Rendered:
        if self.loaded[0] is not scene:
            self.loaded, self.warm = (scene, self.library.load_dict(description(self.library, scene))), set()
            self.frozen.clear()
        if setting not in self.warm:
            # The first pictures of a setting are recorded and compiled, which further ones need not be.
            for seed in range(1, 3):
                self.timed(setting, seed)
            self.warm.add(setting)
        return self.timed(setting, 0)

    def timed(self, samples: int, seed: int) -> Rendered:
        seed = self.library.UInt32(seed)
        self.drjit.make_opaque(seed)
        clock = Clock()
        with clock:
            picture = np.array(self.frozen(self.loaded[1], seed, samples), dtype=float)
        return Rendered(picture, clock.seconds)


def description(library, scene: Scene) -> dict:
    """The scene in a right-handed world: z is negated."""
    x, y, z = scene.toward_light
    world: dict = {
        "type": "scene",
        # The light is of one direction, so that samples of the surface's reflection find nothing.
        "integrator": {"type": "direct", "emitter_samples": 1, "bsdf_samples": 0},
        "sensor": {
            "type": "perspective",
            "fov": scene.fov,
            "fov_axis": "x",
            "to_world": library.ScalarTransform4f().look_at([0, 0, scene.distance], [0, 0, 0], [0, 1, 0]),
            "sampler": {"type": "multijitter"},
            "film": {
                "type": "hdrfilm",
                "width": scene.side,
                "height": scene.side,
                "pixel_format": "rgb",
                "component_format": "float32",
                "rfilter": {"type": "box"},
            },
        },
        # A white surface reflects the share 1/π into a direction.
        "light": {"type": "directional", "direction": [-x, -y, z], "irradiance": {"type": "rgb", "value": math.pi}},
    }
    for index, albedo in enumerate(dict.fromkeys(sphere.albedo for sphere in scene.spheres)):
        bsdf = {"type": "diffuse", "reflectance": {"type": "rgb", "value": list(albedo)}}
        world[f"albedo{index}"] = bsdf | {"id": str(albedo)}
    for index, sphere in enumerate(scene.spheres):
        x, y, z = sphere.center
        bsdf = {"type": "ref", "id": str(sphere.albedo)}
        world[f"sphere{index}"] = {"type": "sphere", "center": [x, y, -z], "radius": sphere.radius, "bsdf": bsdf}
    return world
