"""Data sets for photometric stereo."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Sequence
from typing import Literal, TypeAlias, get_args

from . import _native
from .options import whole, whole_numbers

# Exit codes of the command.
_COMPLETE, _OVER, _INTERRUPTED = 0, 3, 130

Layout: TypeAlias = Literal["diligent", "luces", "lp"]


def dataset(
    scene_path: str | os.PathLike[str],
    output: str | os.PathLike[str],
    *,
    layout: Layout,
    frame: int | None = None,
    tolerance: float | None = None,
    size: Sequence[int] | None = None,
    set: Sequence[str] = (),
    strict: bool = False,
    skip_existing: bool = False,
    threads: int | None = None,
    progress: bool = False,
) -> bool:
    """Writes a picture of each light alone, and the true normals, as `marbles dataset` does.

    Args:
        scene_path: The scene file.
        output: The folder for the files.
        layout: `"diligent"` for distant lights, `"luces"` for near ones, `"lp"` for a list of distant lights.
        frame: The frame of the scene; the first by default.
        tolerance: The largest error before rounding, as a share of the largest code; 1e-4 by default.
        size: (width, height) of the pictures in pixels instead of the scene's.
        set: Values that replace those of the scene: `"materials.red.exponent=2"`.
        strict: Scenes with warnings are refused.
        skip_existing: Complete pictures of the same scene and settings are kept.
        threads: The number of threads; one per core by default.
        progress: Reports of the progress are shown on stderr.

    Returns:
        Whether every pixel is within the tolerance.

    Raises:
        TypeError, ValueError: An option that cannot be.
        RenderError: The command failed; the message is its own, or on stderr with `progress`.
        KeyboardInterrupt: The command was interrupted.
    """
    if layout not in get_args(Layout):
        raise ValueError(f"layout: expected one of {', '.join(get_args(Layout))}, found {layout!r}")
    arguments = [sys.executable, "-m", "marbles", "dataset", f"--output={os.fspath(output)}", f"--layout={layout}"]
    if frame is not None:
        arguments.append(f"--frame={whole(frame, 'frame', -(2**31), 2**31 - 1)}")
    if tolerance is not None:
        arguments.append(f"--tolerance={float(tolerance)!r}")
    numbers = whole_numbers(size, "size", ("width", "height"), 1)
    if numbers is not None:
        arguments.append(f"--size={numbers[0]}x{numbers[1]}")
    if threads is not None:
        arguments.append(f"--threads={whole(threads, 'threads', 1, 2**16)}")
    arguments += [f"--set={setting}" for setting in set]
    arguments += ["--strict"] * strict + ["--skip-existing"] * skip_existing
    arguments += ["--quiet"] if not progress else []
    # A process of its own, whose handlers of signals are not left behind.
    command = [*arguments, "--", os.fspath(scene_path)]
    done = subprocess.run(command, stderr=None if progress else subprocess.PIPE, text=True, check=False)
    if done.returncode == _INTERRUPTED:
        raise KeyboardInterrupt
    if done.returncode not in (_COMPLETE, _OVER):
        reason = (done.stderr or "").strip() or f"marbles dataset ended with the exit code {done.returncode}"
        raise _native.RenderError(reason)
    return done.returncode == _COMPLETE
