"""Animations."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Literal

from .variant import Number, Variant, Vector


class Keyframes(Variant):
    """Numbers of the camera and of lights that change between keys.

    A key is a dict. It has a `frame`, and the numbers at this frame: of the camera, such as `pan`, `position` or
    `zoom`, or with `light`, the name of a light, its `toward`, `position`, `direction`, `mu`, `intensity` or `diameter`.
    Its `ease` is the way to the next key: `"Smooth"` (the default), `"Linear"` or `"Hold"`. Lengths are in scene units,
    angles in degrees.

    Args:
        keys: The keys, such as `[dict(frame=1, pan=0), dict(frame=60, pan=30, ease="Linear")]`.
        frames: The first and the last frame, both included; by default from the first key to the last.
        fps: Frames per second; 24 by default.
        shutter: The exposure time in frames, greater than 0 and at most 1; without it there is no motion blur.
    """

    __slots__ = ()

    def __init__(
        self,
        keys: Sequence[Mapping[str, object]] = (),
        frames: Sequence[int] | None = None,
        fps: Number | None = None,
        shutter: Number | None = None,
    ) -> None:
        super().__init__("Keyframes", frames=frames, fps=fps, shutter=shutter, keys=keys)


class Turntable(Variant):
    """A camera that turns around its target, or lights that turn, from frame 1 on.

    Args:
        frames: The number of frames; 120 by default.
        fps: Frames per second; 24 by default.
        turns: The number of turns; 1 by default. With a whole number the loop has no seam.
        what: `"Camera"` (the default; an `Orbit` or a `Frame`) or `"Lights"`.
        axis: The direction of the axis through the target; (0, 1, 0) by default. Not together with `up`.
        up: The axis of the scene that points up in the picture; `"Y"` by default.
        swing: An angle greater than 0 and at most 180 degrees, by which the camera rocks to both sides instead of
            turning all around.
        shutter: The exposure time in frames, greater than 0 and at most 1; without it there is no motion blur.
    """

    __slots__ = ()

    def __init__(
        self,
        frames: int | None = None,
        fps: Number | None = None,
        turns: Number | None = None,
        *,
        what: Literal["Camera", "Lights"] | None = None,
        axis: Vector | None = None,
        up: Literal["X", "Y", "Z"] | None = None,
        swing: Number | None = None,
        shutter: Number | None = None,
    ) -> None:
        super().__init__(
            "Turntable",
            frames=frames,
            fps=fps,
            shutter=shutter,
            turns=turns,
            what=what,
            axis=axis,
            up=up,
            swing=swing,
        )
