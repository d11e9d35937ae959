"""The camera of a picture as numbers."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True, eq=False)
class Camera:
    """A camera in OpenCV's conventions: x_camera = R X + t, and the pixel is K x_camera / z.

    X is a point of the scene with z negated: this world is right-handed. The axes of the camera are x right, y down, z
    forward. Pixel (0, 0) is the center of the first one. The numbers include the zoom and the shift of the lens.
    """

    K: NDArray[np.float64] | None
    """The matrix of the camera, (3, 3), in pixels; None for a parallel lens."""
    R: NDArray[np.float64]
    """The rotation, (3, 3), with determinant 1."""
    t: NDArray[np.float64]
    """The translation, (3,), in scene units."""
    position: NDArray[np.float64]
    """The viewpoint −Rᵀ t, (3,), in the world with z negated."""
    pixels_per_unit: float | None = None
    """Only for a parallel lens, whose pixel is pixels_per_unit · (x, y)_camera + principal_point."""
    principal_point: NDArray[np.float64] | None = None
    """Only for a parallel lens: (2,), in pixels."""


def camera_of(sidecar: Mapping[str, Any]) -> Camera:
    """The camera of a sidecar."""
    numbers = sidecar["camera"]

    def array(name: str) -> NDArray[np.float64] | None:
        return np.array(numbers[name], np.float64) if numbers.get(name) is not None else None

    scale = numbers.get("pixels_per_unit")
    return Camera(
        K=array("K"),
        R=np.array(numbers["R"], np.float64),
        t=np.array(numbers["t"], np.float64),
        position=np.array(numbers["position"], np.float64),
        pixels_per_unit=None if scale is None else float(scale),
        principal_point=array("principal_point"),
    )
