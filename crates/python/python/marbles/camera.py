"""The camera of a picture as numbers."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray


@dataclass(frozen=True, eq=False)
class Camera:
    """A camera in OpenCV's conventions: x_camera = R X + t, and the pixel is K x_camera / z.

    X is a point of the scene with z negated: this world is right-handed. The axes of the camera are x right, y down, z
    forward. Pixel (0, 0) is the center of the first one. The numbers include the zoom and the shift of the lens.
    """

    K: NDArray[np.float64] | None
    """The matrix of the camera, (3, 3), float64, in pixels; None for a parallel lens."""
    R: NDArray[np.float64]
    """The rotation, (3, 3), float64, with determinant 1."""
    t: NDArray[np.float64]
    """The translation, (3,), float64, in scene units."""
    position: NDArray[np.float64]
    """The viewpoint −Rᵀ t, (3,), float64, in scene units, in the world with z negated."""
    pixels_per_unit: float | None = None
    """Only for a parallel lens, whose pixel is pixels_per_unit · (x, y)_camera + principal_point.

    In pixels per scene unit.
    """
    principal_point: NDArray[np.float64] | None = None
    """Only for a parallel lens: (2,), float64, in pixels."""

    def project(self, points: ArrayLike) -> NDArray[np.float64]:
        """The pixels that see points of the scene, as (column, row); (0, 0) is the center of the first pixel.

        Args:
            points: (n, 3) or (3,), in scene units and in the axes of the scene: x right, y up, z forward.

        Returns:
            (n, 2) or (2,), float64, in pixels. NaN for points that are not in front of the viewpoint.

        Raises:
            ValueError: The last axis of `points` is not 3 long, or what is given is no array of numbers.
        """
        given = np.asarray(points, np.float64)
        if given.shape[-1:] != (3,):
            raise ValueError(f"points: expected the shape (n, 3) or (3,), found {given.shape}")
        x, y, z = np.moveaxis(given * (1, 1, -1) @ self.R.T + self.t, -1, 0)
        if self.K is None:
            assert self.pixels_per_unit is not None and self.principal_point is not None
            return np.stack((x, y), -1) * self.pixels_per_unit + self.principal_point
        depth = np.where(z > 0, z, np.nan)
        return np.stack((x / depth, y / depth), -1) * self.K[[0, 1], [0, 1]] + self.K[:2, 2]


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
