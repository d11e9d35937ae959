"""Tachyon: larger pictures whose pixels are averaged, and its antialiasing by random samples."""

import re
import shutil
import subprocess
from pathlib import Path

from compared.program import Method, Program, Rendered, averaged, grids, read_ppm, run
from compared.scenes import Scene

FIXED = Method(
    "Tachyon, enlarged N × N",
    "tachyon SCENE -res … … -fullshade -numthreads 1 -format PPM48",
    **grids([1, 2, 4, 8, 16, 32]),
)
SAMPLES = [1, 4, 16, 64, 256, 1024]
RANDOM = Method(
    "Tachyon, -aasamples",
    "tachyon SCENE -fullshade -numthreads 1 -format PPM48 -aasamples N",
    [samples - 1 for samples in SAMPLES],
    SAMPLES,
    [str(samples) for samples in SAMPLES],
)
TIME = re.compile(r"Ray Tracing Time: +([0-9.]+) seconds")
TIME_OF_WRITING = re.compile(r"Image I/O Time: +([0-9.]+) seconds")


class Tachyon(Program):
    name = "Tachyon"
    methods = [FIXED, RANDOM]

    def __init__(self):
        # Its exit code says that it has rendered nothing.
        self.version = subprocess.run(["tachyon", "-version"], capture_output=True, text=True).stdout.strip()

    @staticmethod
    def find() -> "Tachyon | None":
        return Tachyon() if shutil.which("tachyon") else None

    def render(self, scene: Scene, method: Method, setting, folder: Path) -> Rendered:
        grid, more = (setting, 0) if method is FIXED else (1, setting)
        write(scene, grid * scene.side, folder / "scene.dat")
        command = ["tachyon", "scene.dat", "-o", "tachyon.ppm", "-format", "PPM48", "-fullshade", "-numthreads", "1"]
        process = run([*command, *(["-aasamples", str(more)] if more else [])], folder)
        reported, writing = (float(time.search(process.printed)[1]) for time in (TIME, TIME_OF_WRITING))
        # Of the processor's time, writing has its share.
        processor = process.processor * (1 - min(writing / process.wall, 1))
        return Rendered(averaged(read_ppm(folder / "tachyon.ppm"), grid), min(reported, processor))


def write(scene: Scene, side: int, path: Path) -> None:
    # Rays go through the upper right corners of pixels, so the retina is moved by half a pixel.
    half, shift = scene.retina / 2, scene.retina / side / 2
    sides = [-half - shift, half - shift, -half - shift, half - shift]
    x, y, z = (-number for number in scene.toward_light)
    spheres = "\n".join(
        "SPHERE CENTER {} {} {} RAD {} TEXTURE AMBIENT 0 DIFFUSE 1 SPECULAR 0 OPACITY 1 COLOR {} {} {} TEXFUNC 0".format(
            *sphere.center, sphere.radius, *sphere.albedo
        )
        for sphere in scene.spheres
    )
    path.write_text(
        f"BEGIN_SCENE\nRESOLUTION {side} {side}\n"
        f"CAMERA\nZOOM {1 / scene.retina}\nASPECTRATIO 1\nANTIALIASING 0\nRAYDEPTH 1\n"
        "CENTER 0 0 {}\nVIEWDIR 0 0 1\nUPDIR 0 1 0\nFRUSTUM {} {} {} {}\nEND_CAMERA\n".format(-scene.distance, *sides)
        + f"BACKGROUND 0 0 0\nDIRECTIONAL_LIGHT DIRECTION {x} {y} {z} COLOR 1 1 1\n{spheres}\nEND_SCENE\n"
    )
