"""Rendered pictures."""

from __future__ import annotations

import json
import os
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from .camera import Camera, camera_of

if TYPE_CHECKING:
    from . import _native

# Arrays that every picture has.
_OWN = ("light", "error", "bound")


class Picture:
    """A rendered frame: light with the error of every pixel, and channels.

    `picture["depth"]` is a channel; `picture["light"]`, `picture["error"]` and `picture["bound"]` are the arrays of
    these names. Row 0 is at the top. A notebook shows the picture itself.
    """

    def __init__(self, native: _native.Picture) -> None:
        self._native = native
        self._arrays = native.arrays

    @property
    def light(self) -> NDArray[np.float64]:
        """Linear light, (height, width, 3), float64: Rec. 709; 1 is a white surface that faces a light of intensity 1.

        With alpha (height, width, 4): colors are premultiplied, and alpha is last, from 0 to 1.
        """
        return self._arrays["light"]

    @property
    def error(self) -> NDArray[np.float64]:
        """What is claimed, (height, width), float64: every channel of `light` is this near to its exact value.

        In the unit of `light`. Infinite where the error is unknown.
        """
        return self._arrays["error"]

    @property
    def bound(self) -> NDArray[np.bool_]:
        """Where the error is a proved bound and not an estimate, (height, width), bool."""
        return self._arrays["bound"]

    @property
    def over(self) -> int:
        """The number of pixels whose error exceeds the tolerance; 0 with `samples`."""
        return self._native.over

    @property
    def largest_error(self) -> float:
        """The largest error of any pixel, in the unit of `light`; infinite if it is unknown."""
        return self._native.largest_error

    @property
    def frame(self) -> int:
        """The number of the frame."""
        return self._native.frame

    @property
    def size(self) -> tuple[int, int]:
        """Width and height in pixels."""
        height, width = self.error.shape
        return width, height

    @property
    def channels(self) -> tuple[str, ...]:
        """The names of the channels that were asked for, and of those that belong to them."""
        return tuple(name for name in self._arrays if name not in _OWN)

    def __getitem__(self, name: str) -> NDArray[Any]:
        """The array of a channel, or `light`, `error`, `bound`.

        Numbers such as `depth` are (height, width), float64. Normals, positions and colors are (height, width, 3),
        float64. `id` and `coverage_id` are (height, width), uint32, with 0xffffffff where no sphere is seen. Depths and
        positions are in scene units; depths are infinite where no sphere is seen, and all other numbers 0.

        Raises:
            KeyError: No such array; the message has the names there are.
        """
        try:
            return self._arrays[name]
        except KeyError:
            raise KeyError(f"expected one of {', '.join(self._arrays)}, found {name!r}") from None

    def __contains__(self, name: object) -> bool:
        return name in self._arrays

    # Else Python would count up from `picture[0]`.
    __iter__ = None

    @cached_property
    def per_light(self) -> dict[str, Picture]:
        """The pictures of single lights by name, "light-1" and so on if they have none, "sky", and "ambient".

        Their sum is the picture, within the errors of all. Empty if they were not asked for.
        """
        return {name: Picture(native) for name, native in self._native.per_light}

    @cached_property
    def sidecar(self) -> dict[str, Any]:
        """The camera, the lights and the results as the command writes them beside a picture.

        Lengths are in scene units and angles in degrees; the camera is in OpenCV's conventions, in pixels.
        """
        sidecar: dict[str, Any] = json.loads(self._native.sidecar)
        return sidecar

    @cached_property
    def camera(self) -> Camera:
        """The camera in OpenCV's conventions: K in pixels, R, and t in scene units."""
        return camera_of(self.sidecar)

    def save(
        self,
        path: str | os.PathLike[str],
        *,
        bits: int | None = None,
        linear: bool = False,
        exposure: float | None = None,
        rgb: bool = False,
        float: bool = False,
        error: bool = False,
        sidecar: bool = False,
    ) -> None:
        """Writes the picture as the command does; the ending of the name chooses the format.

        Args:
            path: A name that ends with .png, .tif, .exr, .npy or .npz.
            bits: 8 or 16 bits per channel of a PNG; 8 by default, 16 with `linear`.
            linear: Codes of a PNG that are proportional to light instead of sRGB.
            exposure: Light is multiplied by 2^exposure before it is converted to codes of a PNG or TIFF.
            rgb: A PNG or TIFF in color even if the scene is gray.
            float: An EXR or TIFF in single precision.
            error: The error of every pixel is stored, too; in EXR, NPY and NPZ.
            sidecar: NAME.json is written beside the picture.

        Raises:
            ValueError: Options that do not go with the format, or an unknown format.
            OSError: The file cannot be written.
        """
        if bits is not None and bits not in (8, 16):
            raise ValueError(f"bits: expected 8 or 16, found {bits!r}")
        try:
            self._native.save(
                os.fspath(path),
                bits=bits,
                linear=linear,
                exposure=exposure,
                rgb=rgb,
                float=float,
                error=error,
                sidecar=sidecar,
            )
        except ValueError as refused:
            # The options of the command have the names of arguments.
            message = str(refused).replace("--error-channel", "error").replace("--", "")
            raise ValueError(message) from None

    def to_srgb(self) -> NDArray[np.uint8]:
        """The sRGB codes of the 8-bit PNG, (height, width, 3), uint8; with straight alpha (height, width, 4)."""
        return self._native.to_srgb()

    def _repr_png_(self) -> bytes:
        return self._native.png()

    def __repr__(self) -> str:
        width, height = self.size
        return f"<Picture {width} x {height}, frame {self.frame}, error <= {self.largest_error:.1e}, {self.over} over>"
