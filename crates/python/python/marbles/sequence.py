"""The frames of a sequence, one after another."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from types import TracebackType
from typing import TYPE_CHECKING

from .faults import warn
from .picture import Picture

if TYPE_CHECKING:
    from . import _native
    from .options import Options


class Frames(Iterator[Picture]):
    """An iterator of pictures. The scene is prepared once for all of them.

    `close()` ends the work early, and so does leaving a `with` block, or dropping the iterator. Pictures come in the
    order of the frames that were asked for.

    Raises:
        SceneError: While pictures are taken: a table of a frame is refused.
        RenderError: While pictures are taken: the rendering failed, or it belongs to the process that this one was
            forked from.
        KeyboardInterrupt: While pictures are taken: Ctrl-C, which ends the work.
    """

    def __init__(self, scene: _native.Scene, frames: Sequence[int], options: Options) -> None:
        self._scene = scene
        self._rendering: _native.Rendering | None = scene.start(frames, **options) if frames else None
        # Mistakes in the first frame, such as a camera that sees no sphere.
        self._mistakes = self._rendering.warnings if self._rendering else []

    def __iter__(self) -> Frames:
        return self

    def __next__(self) -> Picture:
        picture = self._next(stacklevel=2)
        if picture is None:
            raise StopIteration
        return picture

    def _next(self, stacklevel: int) -> Picture | None:
        rendering = self._rendering
        if rendering is None:
            return None
        try:
            native = rendering.next()
        except BaseException:
            self.close()
            raise
        warn([*self._mistakes, *self._scene.take_warnings()], stacklevel + 1)
        self._mistakes = []
        if native is None:
            self.close()
            return None
        return Picture(native)

    def close(self) -> None:
        """Ends the work. After that there are no more pictures. Does nothing if the work has ended."""
        rendering, self._rendering = self._rendering, None
        if rendering is not None:
            rendering.stop()

    def __enter__(self) -> Frames:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()
