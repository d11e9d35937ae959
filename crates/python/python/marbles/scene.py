"""Scenes: made in Python, or read from files."""

from __future__ import annotations

import json
import os
import warnings
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any, NoReturn, TypeAlias, Union

import numpy as np
from numpy.typing import NDArray

from . import _native, draft, files
from .camera import Camera, camera_of
from .cloud import Spheres
from .draft import Draft
from .faults import SceneWarning, python_paths, warn
from .lights import Sky
from .options import Axes, Depth, checked, whole
from .picture import Picture
from .sequence import Frames
from .variant import Color, Number, Value, Variant

Named: TypeAlias = Union[Variant, Mapping[str, object]]
"""A value with a name: a variant, or a dict such as `{"Fov": 40}`."""

_FIELDS = (
    "image", "lens", "camera", "zoom", "unit", "background", "ambient", "sky", "shadows", "lights", "materials",
    "spheres", "clouds", "animation",
)  # fmt: skip


class Scene:
    """A scene of spheres. It is checked when it is made, and cannot be changed.

    The arguments are the fields of a scene file, with the same names, units, axes and defaults: lengths in scene
    units, angles in degrees, x right, y up, z forward. What is None is left out.

    Args:
        image: The size of the picture: `dict(width=300, height=200)`, in pixels.
        lens: `Fov`, `Retina`, `Matrix` or `Parallel`.
        camera: `Free`, `LookAt`, `Orbit`, `Frame` or `Pose`.
        zoom: Multiplies the size of everything near the center of the picture; 1 by default.
        unit: The unit of lengths, which scale bars show.
        background: The color where there is no sphere; 0 by default.
        ambient: The color of the light that reaches every point; 0 by default.
        sky: The light from all directions that no sphere hides: a color, or `Sky` with two; none by default.
        shadows: Whether spheres cast shadows; True by default.
        lights: `Directional` and `Point`.
        materials: Dicts by name, with `albedo`, `exponent`, `highlight`, `rough`, `outline`.
        spheres: `Spheres`, or a list of dicts with `center`, `radius` and `material`, and of `Spheres`.
        clouds: Tables in files: dicts with `file` and more. Names are relative to the current folder.
        animation: `Keyframes` or `Turntable`.

    Raises:
        SceneError: A value that the scene refuses; `path` is its place, such as `spheres[3].radius`.
        TypeError, ValueError: A value that no scene can have; the message begins with its place.
    """

    __slots__ = ("_draft", "_file", "_is_file", "_native")

    _draft: Draft
    _file: str
    _native: _native.Scene
    _is_file: bool

    def __init__(
        self,
        *,
        image: Mapping[str, object],
        lens: Named,
        camera: Named,
        zoom: Number | None = None,
        unit: str | None = None,
        background: Color | None = None,
        ambient: Color | None = None,
        sky: Color | Sky | Mapping[str, object] | None = None,
        shadows: bool | None = None,
        lights: Sequence[Named] = (),
        materials: Mapping[str, Mapping[str, object]] | None = None,
        spheres: Spheres | Sequence[Mapping[str, object] | Spheres] = (),
        clouds: Sequence[Mapping[str, object]] = (),
        animation: Named | None = None,
    ) -> None:
        values = (
            image, lens, camera, zoom, unit, background, ambient, sky, shadows, lights, materials, spheres, clouds,
            animation,
        )  # fmt: skip
        made = draft.new(dict(zip(_FIELDS, values)))
        _fill(self, made, os.path.abspath("scene.ron"), is_file=False, stacklevel=3)

    def __setattr__(self, name: str, value: object) -> NoReturn:
        raise AttributeError("a scene cannot be changed: `scene.replace(…)` makes another one")

    def __reduce__(self) -> tuple[object, ...]:
        # The text and the tables: another process reads them again.
        return _again, (self._draft, self._file, self._is_file)

    def __repr__(self) -> str:
        width, height = self.size
        frames = "" if self.frame_range is None else ", frames {} to {}".format(*self.frame_range)
        return f"<Scene {Path(self._file).name}, {width} x {height}{frames}>"

    @property
    def text(self) -> str:
        """The scene in RON. Tables in memory have names such as `spheres.npy`."""
        return self._draft.text

    @property
    def size(self) -> tuple[int, int]:
        """Width and height of the picture in pixels."""
        return self._native.size

    @property
    def frame_range(self) -> tuple[int, int] | None:
        """The first and the last frame, both included; None for a still."""
        return self._native.frames

    @property
    def frames_per_second(self) -> float | None:
        """The speed of the animation, in frames per second; None for a still."""
        return self._native.frames_per_second

    @property
    def materials(self) -> list[str]:
        """The names of the materials, in order."""
        return list(self._native.materials)

    @property
    def lights(self) -> list[str | None]:
        """The names of the lights, in order; None for a light without a name."""
        return list(self._native.lights)

    @property
    def warnings(self) -> list[str]:
        """Oversights in the scene, such as a light without effect. They were issued as `SceneWarning`, too."""
        return list(self._native.warnings)

    def replace(self, **fields: Value | Spheres | Sequence[Mapping[str, object] | Spheres]) -> Scene:
        """Another scene, with other values in some fields; None leaves a field out.

        New `spheres` take the place of single spheres and of all arrays of spheres made in Python; new `clouds` take
        the place of the tables in files. The rest of the text stays as it is, with its comments.

        Raises:
            SceneError, TypeError, ValueError: As for a new scene.
        """
        made = draft.replaced(self._draft, fields)
        return _fill(Scene.__new__(Scene), made, self._file, is_file=False, stacklevel=3, known=self.warnings)

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes the scene in RON, and its arrays of spheres as NAME_spheres.npy beside it.

        No file has its name before it is complete. Names of other tables are changed so that they lead to the same
        files.

        Raises:
            OSError: A file cannot be written.
        """
        files.save(self._draft, Path(self._file).parent, Path(path).absolute())

    def render(
        self,
        tolerance: float | None = None,
        *,
        samples: int | None = None,
        frame: int | None = None,
        channels: Iterable[str] = (),
        per_light: bool = False,
        alpha: bool = False,
        depth: Depth = "axis",
        axes: Axes = "world",
        size: Sequence[int] | None = None,
        region: Sequence[int] | None = None,
        threads: int | None = None,
        progress: bool = False,
    ) -> Picture:
        """Renders a frame. Its pixels are to the bit those of the command.

        Args:
            tolerance: The largest error of every channel of every pixel, absolute, in linear light; 1e-3 by default.
                Pixels over it are no error: `Picture.over` counts them.
            samples: samples² rays per pixel instead, whatever the error.
            frame: The number of the frame; by default the first one of the animation, or 1.
            channels: `depth`, `normal`, `position`, `albedo`, `id`, `mask` of the ray through the center of each pixel;
                `mean_normal`, `coverage_id`, averages over each pixel.
            per_light: Each light is rendered alone, too.
            alpha: The background is left out; the last channel is the share of the pixel that spheres cover.
            depth: Along the axis of view, or from the viewpoint.
            axes: Those of normals and positions: left-handed as in the scene, or those of the camera.
            size: (width, height) in pixels instead of the scene's.
            region: (column, row, width, height): only a part of the picture.
            threads: The number of threads; one per core by default. Pixels are the same for every number.
            progress: A bar is shown.

        Raises:
            TypeError, ValueError: Options that cannot be; a frame that the scene does not have.
            SceneError: A table of this frame is refused.
            RenderError: The rendering failed.
            KeyboardInterrupt: Ctrl-C; the scene can still be used.
        """
        options = checked(
            tolerance, samples=samples, channels=channels, per_light=per_light, alpha=alpha, depth=depth, axes=axes,
            size=size, region=region, threads=threads, progress=progress,
        )  # fmt: skip
        with Frames(self._native, [self._frame(frame)], options) as frames:
            picture = frames._next(stacklevel=2)
        if picture is None:
            raise _native.RenderError("expected a picture, found none")
        return picture

    def frames(
        self,
        tolerance: float | None = None,
        *,
        frames: Iterable[int] | None = None,
        samples: int | None = None,
        channels: Iterable[str] = (),
        per_light: bool = False,
        alpha: bool = False,
        depth: Depth = "axis",
        axes: Axes = "world",
        size: Sequence[int] | None = None,
        region: Sequence[int] | None = None,
        threads: int | None = None,
        progress: bool = False,
    ) -> Frames:
        """Renders several frames, one after another; the scene is prepared once.

        Args:
            frames: Their numbers, in the order of rendering, such as `range(1, 11)`; all frames by default.

        The other arguments are those of `render`. Leaving the loop early ends the work when the iterator is dropped or
        closed.

        Raises:
            TypeError, ValueError: Options that cannot be; a frame that the scene does not have, or that comes twice.

        While pictures are taken, the errors are those of `Frames`.
        """
        options = checked(
            tolerance, samples=samples, channels=channels, per_light=per_light, alpha=alpha, depth=depth, axes=axes,
            size=size, region=region, threads=threads, progress=progress,
        )  # fmt: skip
        if frames is None:
            first, last = self.frame_range or (1, 1)
            frames = range(first, last + 1)
        numbers: dict[int, None] = {}
        for index, frame in enumerate(frames):
            number = self._frame(frame, f"frames[{index}]")
            if number in numbers:
                raise ValueError(f"frames[{index}]: expected each frame once, found {number} again")
            numbers[number] = None
        return Frames(self._native, list(numbers), options)

    def spheres_table(self, frame: int | None = None) -> dict[str, NDArray[Any]]:
        """The spheres of a frame, in the order of the channel `id`, as columns of a table, such as a DataFrame.

        Every column is an array (n,). `x`, `y`, `z` and `radius` are float64, in scene units and in the scene's axes;
        `red`, `green` and `blue` are float64, the linear albedo; `material` has the names of materials as texts, empty
        for matte white. `frame` is the first one by default.

        Raises:
            TypeError, ValueError: A frame that the scene does not have.
            SceneError: A table of this frame is refused.
        """
        native = self._native.spheres(self._frame(frame))
        warn(self._native.take_warnings(), 2)
        names = np.array([*self._native.materials, ""])
        columns = [*native["center"].T, native["radius"], *native["albedo"].T]
        table = dict(zip(("x", "y", "z", "radius", "red", "green", "blue"), map(np.ascontiguousarray, columns)))
        return table | {"material": names[np.minimum(native["material"], len(names) - 1)]}

    def camera(self, frame: int | None = None) -> Camera:
        """The camera of a frame in OpenCV's conventions: K in pixels, R, and t in scene units.

        `frame` is the first one by default.

        Raises:
            TypeError, ValueError: A frame that the scene does not have.
        """
        return camera_of(json.loads(self._native.sidecar(self._frame(frame), None)))

    def _frame(self, frame: int | None, name: str = "frame") -> int:
        first, last = self.frame_range or (1, 1)
        return first if frame is None else whole(frame, name, first, last)


def _fill(
    scene: Scene, made: Draft, file: str, *, is_file: bool, stacklevel: int, known: Sequence[str] = ()
) -> Scene:
    """Reads a scene's text; faults of what is no file are told with the paths of Python.

    Warnings that are `known` are not issued again.
    """
    if is_file:
        native = _native.Scene.parse(made.text, file, {})
    else:
        with python_paths(made.rename, made.paths()):
            native = _native.Scene.parse(made.text, file, made.files())
    for name, value in (("_draft", made), ("_file", file), ("_native", native), ("_is_file", is_file)):
        object.__setattr__(scene, name, value)
    warn([message for message in native.warnings if message not in known], stacklevel)
    return scene


def _again(made: Draft, file: str, is_file: bool) -> Scene:
    """A scene that was copied or sent to another process. Its warnings were issued."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", SceneWarning)
        return _fill(Scene.__new__(Scene), made, file, is_file=is_file, stacklevel=3)


def load(path: str | os.PathLike[str]) -> Scene:
    """The scene of a file in RON or JSON, or the figure that the command makes for a table of particles.

    Raises:
        SceneError: The scene is refused; `path`, `line` and `column` tell where.
        OSError: The file cannot be read.
    """
    file = os.path.abspath(path)
    with open(file, "rb"):
        # What cannot be opened is told as Python tells it.
        pass
    text = _native.to_ron(_native.scene_text(file))
    return _fill(Scene.__new__(Scene), Draft(text), file, is_file=True, stacklevel=3)


def loads(text: str, folder: str | os.PathLike[str] = ".") -> Scene:
    """The scene of a text in RON or JSON, whose tables are in a folder.

    Raises:
        SceneError: The scene is refused; `path`, `line` and `column` tell where.
        TypeError: `text` is no text.
    """
    if not isinstance(text, str):
        raise TypeError(f"text: expected a scene as a text, found {type(text).__name__}")
    file = os.path.join(os.path.abspath(folder), "scene.ron")
    return _fill(Scene.__new__(Scene), Draft(_native.to_ron(text)), file, is_file=True, stacklevel=3)


def spheres(scene: Scene, frame: int | None = None) -> dict[str, NDArray[Any]]:
    """The spheres of a frame as columns (n,) of a table, float64 and texts: the same as `scene.spheres_table(frame)`.

    Raises:
        TypeError, ValueError: A frame that the scene does not have.
        SceneError: A table of this frame is refused.
    """
    return scene.spheres_table(frame)
