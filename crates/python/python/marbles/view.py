"""Lenses and cameras. Lengths are in scene units, angles in degrees."""

from __future__ import annotations

from typing import Literal

from .variant import Number, Value, Variant, Vector


class Fov(Variant):
    """A lens with a horizontal field of view.

    Args:
        degrees: The angle in degrees, greater than 0 and less than 180.
    """

    __slots__ = ()

    def __init__(self, degrees: Number) -> None:
        super().__init__("Fov", degrees)


class Retina(Variant):
    """A lens given by its retina, the rectangle through which the camera looks. Lengths are in scene units.

    Args:
        width: The width of the retina, greater than 0.
        distance: Its distance from the viewpoint, greater than 0.
        shift: The way of its center to the right and up; (0, 0) by default.
    """

    __slots__ = ()

    def __init__(self, width: Number, distance: Number, shift: Vector | None = None) -> None:
        super().__init__("Retina", width=width, distance=distance, shift=shift)


class Matrix(Variant):
    """A lens given by a camera matrix in pixels, for the picture size of the scene.

    The point (0, 0) is the center of the first pixel. If fx and fy differ, pixels are rectangles.

    Args:
        fx, fy: The focal lengths in pixels, greater than 0.
        cx, cy: The principal point in pixels.
    """

    __slots__ = ()

    def __init__(self, fx: Number, fy: Number, cx: Number, cy: Number) -> None:
        super().__init__("Matrix", fx=fx, fy=fy, cx=cx, cy=cy)


class Parallel(Variant):
    """A lens whose rays are all parallel to the axis of view.

    Args:
        width: The width of the picture in scene units, greater than 0.
        shift: The way of its center to the right and up, in scene units; (0, 0) by default.
    """

    __slots__ = ()

    def __init__(self, width: Number, shift: Vector | None = None) -> None:
        super().__init__("Parallel", width=width, shift=shift)


class Free(Variant):
    """A camera at a position, in scene units; angles are in degrees. By default it is at the origin and looks along z.

    Args:
        position: The viewpoint.
        pan: The turn about the vertical axis, to the right.
        tilt: How far the view is raised.
        roll: The turn about the axis of view, clockwise as seen from behind the camera.
    """

    __slots__ = ()

    def __init__(
        self,
        position: Vector | None = None,
        pan: Number | None = None,
        tilt: Number | None = None,
        roll: Number | None = None,
    ) -> None:
        super().__init__("Free", position=position, pan=pan, tilt=tilt, roll=roll)


class LookAt(Variant):
    """A camera that looks at a target. Points are in scene units, angles in degrees.

    Args:
        position: The viewpoint.
        target: The point that is shown at the center of the picture.
        roll: The turn about the axis of view; 0 by default.
    """

    __slots__ = ()

    def __init__(self, position: Vector, target: Vector, roll: Number | None = None) -> None:
        super().__init__("LookAt", position=position, target=target, roll=roll)


class Orbit(Variant):
    """A camera that looks at a target from a distance. Lengths are in scene units, angles in degrees.

    Args:
        target: The point that is shown at the center of the picture.
        radius: The distance, greater than 0.
        azimuth: The turn about the target; at 0, the default, the camera looks along z.
        elevation: How far the camera looks down; 0 by default.
        roll: The turn about the axis of view; 0 by default.
    """

    __slots__ = ()

    def __init__(
        self,
        target: Vector,
        radius: Number,
        azimuth: Number | None = None,
        elevation: Number | None = None,
        roll: Number | None = None,
    ) -> None:
        super().__init__("Orbit", target=target, radius=radius, azimuth=azimuth, elevation=elevation, roll=roll)


class Frame(Variant):
    """An orbit whose target and radius are chosen so that all spheres are in the picture.

    Args:
        azimuth, elevation, roll: As for `Orbit`, in degrees; 0 by default.
        fill: The part of the picture that the spheres fill, greater than 0 and at most 1; 0.9 by default.
        frame_over: `"Series"` (the default) for the spheres of all steps of tables, `"Step"` for those of the
            frame's step.
    """

    __slots__ = ()

    def __init__(
        self,
        azimuth: Number | None = None,
        elevation: Number | None = None,
        roll: Number | None = None,
        fill: Number | None = None,
        frame_over: Literal["Series", "Step"] | None = None,
    ) -> None:
        super().__init__(
            "Frame", azimuth=azimuth, elevation=elevation, roll=roll, fill=fill, frame_over=frame_over
        )


class Pose(Variant):
    """A camera calibrated with OpenCV: x_camera = R X + t, in the right-handed world with z negated.

    `Pose(picture.camera.R, picture.camera.t)` is the camera of a picture.

    Args:
        rotation: R, an array (3, 3) or nine numbers row by row. It may differ from a rotation by rounding only.
        translation: t, three numbers in scene units.
        axes: The axes in which both are given.
    """

    __slots__ = ()

    def __init__(self, rotation: Value, translation: Vector, axes: Literal["OpenCV"] = "OpenCV") -> None:
        super().__init__("Pose", rotation=rotation, translation=translation, axes=axes)
