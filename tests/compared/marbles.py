"""marbles: to a tolerance, and by plain supersampling."""

import json
from pathlib import Path

import numpy as np

from compared.program import Method, Program, Rendered, grids, run
from compared.scenes import Scene

TOLERANCES = [1e-1, 1e-2, 1e-3, 1e-4, 1e-5]
TO_TOLERANCE = Method(
    "marbles, to a tolerance",
    "marbles render SCENE -o NAME.npy --threads 1 --tolerance E",
    [f"--tolerance={tolerance:.0e}" for tolerance in TOLERANCES],
    [1.0] * len(TOLERANCES),
    [f"{tolerance:.0e}".replace("e-0", "e-") for tolerance in TOLERANCES],
)
SIDES = [1, 2, 4, 8, 16, 32, 64]
BY_SAMPLES = Method(
    "marbles, samples",
    "marbles render SCENE -o NAME.npy --threads 1 --samples N",
    **grids(SIDES) | {"settings": [f"--samples={side}" for side in SIDES]},
)


class Marbles(Program):
    name = "marbles"
    methods = [TO_TOLERANCE, BY_SAMPLES]

    def __init__(self, path: str):
        self.path = str(Path(path).resolve())
        self.version = run([self.path, "--version"], Path()).printed.split()[1]

    def render(self, scene: Scene, method: Method, setting, folder: Path) -> Rendered:
        return self.with_errors(scene, setting, folder)[0]

    def with_errors(self, scene: Scene, setting: str, folder: Path) -> tuple[Rendered, np.ndarray]:
        """A picture, and what marbles claims that its pixels are off by at most."""
        write(scene, folder / "scene.ron")
        command = [self.path, "render", "scene.ron", "-o", "marbles.npy", "--error-channel"]
        process = run([*command, "--threads=1", "--progress=json", setting], folder)
        events = [json.loads(line) for line in process.printed.splitlines() if line.startswith("{")]
        reported = next(event["seconds"] for event in events if event["event"] == "frame")
        picture, errors = np.load(folder / "marbles.npy"), np.load(folder / "marbles_error.npy")
        # With reading and writing, the process has no less than rendering.
        return Rendered(picture, min(reported, process.processor)), errors


def write(scene: Scene, path: Path) -> None:
    albedos = list(dict.fromkeys(sphere.albedo for sphere in scene.spheres))
    materials = ", ".join(f'"{index}": (albedo: {albedo})' for index, albedo in enumerate(albedos))
    spheres = ",\n".join(
        f'(center: {sphere.center}, radius: {sphere.radius}, material: "{albedos.index(sphere.albedo)}")'
        for sphere in scene.spheres
    )
    path.write_text(
        f"(image: (width: {scene.side}, height: {scene.side}), lens: Fov({scene.fov}), camera: Free(position: (0, 0, {-scene.distance})),\n"
        f"lights: [Directional(toward: {scene.toward_light})], materials: {{{materials}}}, spheres: [{spheres}])"
    )
