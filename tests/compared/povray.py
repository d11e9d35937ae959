"""POV-Ray: larger pictures whose pixels are averaged, and its adaptive antialiasing."""

import re
import shutil
from pathlib import Path

import numpy as np

from compared.program import Method, Program, Rendered, averaged, grids, read_ppm, run
from compared.scenes import Scene

FIXED = Method(
    "POV-Ray, enlarged N × N",
    "povray +ISCENE +W… +H… +FP16 File_Gamma=1.0 -A +WT1",
    **grids([1, 2, 4, 8, 16, 32]),
)
DEPTHS = [(0.3, 2), (0.1, 3), (0.03, 4), (0.01, 5), (0.003, 6), (0.001, 7)]
ADAPTIVE = Method(
    "POV-Ray, adaptive",
    "povray +ISCENE +W… +H… +FP16 File_Gamma=1.0 +AM2 +AE +RD -J +AG1.0 +WT1",
    [[f"+A{threshold}", "+AM2", f"+R{depth}", "-J", "+AG1.0"] for threshold, depth in DEPTHS],
    [4.0**index for index in range(len(DEPTHS))],
    [f"+A{threshold} +R{depth}" for threshold, depth in DEPTHS],
)
# Of rendering, and how much of it this program had a processor.
TIME = re.compile(r"Trace Time:.*\(([0-9.]+) seconds\)\s+using 1 thread\(s\) with ([0-9.]+) CPU-seconds")
# Far enough that no sphere of a scene is beyond it.
LIGHT_DISTANCE = 1e5


class PovRay(Program):
    name = "POV-Ray"
    methods = [FIXED, ADAPTIVE]

    def __init__(self):
        self.version = re.search(r"POV-Ray ([0-9.]*[0-9])", run(["povray", "--version"], Path()).printed)[1]

    @staticmethod
    def find() -> "PovRay | None":
        return PovRay() if shutil.which("povray") else None

    def render(self, scene: Scene, method: Method, setting, folder: Path) -> Rendered:
        grid, options = (setting, ["-A"]) if method is FIXED else (1, setting)
        window = (0, 0, scene.side)
        return self.window(scene, window, grid, folder, options)

    def window(self, scene: Scene, window: tuple[int, int, int], grid: int, folder: Path, options=("-A",)) -> Rendered:
        """The square part of a picture that begins at a column and a row and has some pixels a side."""
        write(scene, window, folder / "scene.pov")
        side = grid * window[2]
        command = ["povray", "+Iscene.pov", "+Opovray.ppm", f"+W{side}", f"+H{side}", "+FP16", "File_Gamma=1.0"]
        process = run([*command, "+WT1", "-D", "-V", *options], folder)
        seconds = min(map(float, TIME.search(process.printed).groups()))
        return Rendered(averaged(read_ppm(folder / "povray.ppm"), grid), seconds)


def write(scene: Scene, window: tuple[int, int, int], path: Path) -> None:
    """Writes a scene whose camera sees a part of the picture, through a plane at the distance 1."""
    col, row, side = window
    width = scene.retina * side / scene.side
    middle = np.array([col + side / 2 - scene.side / 2, scene.side / 2 - row - side / 2]) * scene.retina / scene.side
    light = LIGHT_DISTANCE * np.array(scene.toward_light)
    spheres = "\n".join(
        f"sphere {{ <{x}, {y}, {z}>, {sphere.radius} pigment {{ color rgb <{r}, {g}, {b}> }} }}"
        for sphere in scene.spheres
        for (x, y, z), (r, g, b) in [(sphere.center, sphere.albedo)]
    )
    path.write_text(
        "#version 3.7;\n"
        "global_settings { assumed_gamma 1 }\n"
        "#default { finish { ambient 0 diffuse 1 } }\n"
        f"camera {{ perspective location {-scene.distance}*z direction <{middle[0]}, {middle[1]}, 1> right {width}*x up {width}*y }}\n"
        f"light_source {{ <{light[0]}, {light[1]}, {light[2]}> color rgb 1 parallel point_at 0 }}\n"
        f"{spheres}\n"
    )
