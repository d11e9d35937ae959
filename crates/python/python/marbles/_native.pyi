"""The compiled half of the package. Use the names of `marbles` instead."""

from collections.abc import Mapping, Sequence
from typing import Any, final

import numpy as np
from numpy.typing import NDArray

VERSION: str
"""The version of the package and of the command."""

@final
class Fault:
    """One fault of a refused scene."""

    path: str
    """The place of the value, such as `spheres[3].radius`; empty if the fault belongs to no value."""
    line: int
    """The line of the text, from 1."""
    column: int
    """The column of the line in characters, from 1."""
    message: str
    """What was expected and what was found."""

class SceneError(ValueError):
    """A scene, or a table of it, that is refused.

    `path`, `line` and `column` are those of the first fault.
    """

    faults: list[Fault]
    """All faults, in the order of the text."""
    file: str
    """The refused file: the scene, or a table."""
    path: str
    """The place of the value, such as `spheres[3].radius`; empty if the fault belongs to no value."""
    line: int | None
    """The line of the file, from 1; None if no file is meant."""
    column: int | None
    """The column of the line in characters, from 1; None if no file is meant."""

class RenderError(RuntimeError):
    """A rendering that failed: no memory, no space on the disk, or a table that changed meanwhile."""

def run(arguments: Sequence[str]) -> int:
    """Runs the command; `arguments[0]` is its name. Returns the exit code."""

def to_ron(text: str) -> str:
    """A scene in JSON as RON, in which every token keeps its place; RON as it is. Raises SceneError."""

def set_value(text: str, path: str, value: str) -> str:
    """The RON text with `value` (RON) at `path`, such as `lights[0].toward`; adds missing fields. Raises SceneError."""

def value_at(text: str, path: str) -> str | None:
    """The RON text of the value at `path`; None if there is none."""

def scene_text(path: str) -> str:
    """The text of a scene file, or of the figure made for a table of particles. Raises SceneError or OSError."""

@final
class Scene:
    """A scene that was read and checked."""

    @staticmethod
    def parse(text: str, path: str, tables: Mapping[str, bytes]) -> Scene:
        """Reads a scene.

        `path` is named in messages, and tables are looked for in its folder. `tables` are files in memory, by
        the names that `file` of a cloud has. Raises SceneError.
        """
    size: tuple[int, int]
    """Width and height in pixels."""
    frames: tuple[int, int] | None
    """The first and the last frame of the animation; None for a still."""
    frames_per_second: float | None
    """The speed of the animation; None for a still."""
    materials: list[str]
    """The names of the materials, in the order of the scene."""
    lights: list[str | None]
    """The names of the lights, in the order of the scene."""
    warnings: list[str]
    """Oversights in the scene, such as a light without effect."""
    def take_warnings(self) -> list[str]:
        """The warnings that came while frames were read; each is returned once."""

    def spheres(self, frame: int) -> dict[str, NDArray[Any]]:
        """The spheres of a frame: `center` (n, 3), `radius` (n,), `albedo` (n, 3), float64, and `material` (n,), uint32.

        `material` is an index into `materials`, or 0xffffffff for none.
        """

    def sidecar(self, frame: int, size: tuple[int, int] | None) -> str:
        """Camera and lights of a frame as JSON, without the results of rendering."""

    def start(
        self,
        frames: Sequence[int],
        *,
        tolerance: float | None,
        samples: int | None,
        alpha: bool,
        channels: Sequence[str],
        depth: str,
        axes: str,
        size: tuple[int, int] | None,
        region: tuple[int, int, int, int] | None,
        per_light: bool,
        threads: int | None,
        progress: bool,
    ) -> Rendering:
        """Starts to render frames. Exactly one of `tolerance` and `samples` is not None.

        Raises ValueError for values that the command would refuse.
        """

@final
class Rendering:
    """Frames that are being rendered."""

    warnings: list[str]
    """Mistakes in the first frame, such as a camera that sees no sphere."""
    def next(self) -> Picture | None:
        """Waits for the next picture; None after the last one. Ctrl-C ends the rendering with KeyboardInterrupt.

        Raises SceneError if a table of the frame is refused, and RenderError.
        """

    def stop(self) -> None:
        """Ends the work. Does nothing if it has ended."""

@final
class Picture:
    """A rendered frame."""

    frame: int
    """The number of the frame."""
    arrays: dict[str, NDArray[Any]]
    """`light`, `error`, `bound` and the channels by their names, each (height, width) or (height, width, n).

    They are float64; `bound` is bool, and indices of spheres are uint32.
    """
    per_light: list[tuple[str, Picture]]
    """The pictures of single lights by name, that of the ambient light last; empty if they were not asked for."""
    over: int
    """The number of pixels whose error exceeds the tolerance."""
    largest_error: float
    """The largest error of any pixel; infinite if it is unknown."""
    sidecar: str
    """The JSON text that the command writes beside the picture."""
    def save(
        self,
        path: str,
        *,
        bits: int | None,
        linear: bool,
        exposure: float | None,
        rgb: bool,
        float: bool,
        error: bool,
        sidecar: bool,
    ) -> None:
        """Writes the picture in the format that the ending of the name chooses. Raises ValueError or OSError."""

    def to_srgb(self) -> NDArray[np.uint8]:
        """The codes of the 8-bit PNG, (height, width, 3), uint8, or (height, width, 4) with alpha."""

    def png(self) -> bytes:
        """The bytes of the 8-bit PNG."""
