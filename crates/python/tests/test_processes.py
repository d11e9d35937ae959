"""Forked processes, and threads that render at once. Whatever waits for ever is ended, and fails."""

from __future__ import annotations

import multiprocessing
import os
import signal
import sys
import threading
import traceback
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from types import FrameType

import marbles
import pytest
from conftest import ball

# More than the slowest of these tests takes, many times over.
SECONDS = 120

pytestmark = [
    pytest.mark.skipif(not hasattr(os, "fork"), reason="the system has no fork"),
    # Python 3.12 and later warn about a fork beside threads, such as those that marbles keeps.
    pytest.mark.filterwarnings("ignore:.*multi-threaded.*fork:DeprecationWarning"),
]


def _late(number: int, frame: FrameType | None) -> None:
    raise TimeoutError(f"expected an end within {SECONDS} s")


@pytest.fixture(autouse=True)
def deadline() -> Iterator[None]:
    """Ends a test that waits for ever."""
    before = signal.signal(signal.SIGALRM, _late)
    signal.alarm(SECONDS)
    yield
    signal.alarm(0)
    signal.signal(signal.SIGALRM, before)


def light(scene: marbles.Scene, threads: int | None = None, frame: int | None = None) -> bytes:
    return scene.render(1e-2, threads=threads, frame=frame).light.tobytes()


def forked(work: Callable[[], bytes]) -> bytes:
    """What a forked process returns. It is killed if it waits for ever."""
    reader, writer = os.pipe()
    child = os.fork()
    if child == 0:
        signal.signal(signal.SIGALRM, signal.SIG_DFL)
        signal.alarm(SECONDS // 2)
        code = 1
        try:
            os.close(reader)
            with open(writer, "wb") as file:
                file.write(work())
            code = 0
        except BaseException:
            traceback.print_exc()
        finally:
            # Without the ends of pytest, whose process this is not.
            sys.stderr.flush()
            os._exit(code)
    os.close(writer)
    with open(reader, "rb") as file:
        found = file.read()
    _, status = os.waitpid(child, 0)
    assert os.waitstatus_to_exitcode(status) == 0
    return found


@pytest.mark.parametrize("threads", [None, 1, 3])
def test_a_forked_process_renders_and_so_does_its_parent(threads: int | None) -> None:
    scene = ball()
    # Threads of this pool are not in the child.
    before = light(scene, threads)
    assert forked(lambda: light(scene, threads)) == before
    assert light(scene, threads) == before
    # The pool of another number of threads, in a child of the child, and a scene that is made there.
    assert forked(lambda: forked(lambda: light(ball(), 2))) == before
    assert light(scene, threads) == before


def test_a_child_renders_in_threads(turning: marbles.Scene) -> None:
    def all_frames() -> bytes:
        with ThreadPoolExecutor(6) as pool:
            return b"".join(pool.map(lambda frame: light(turning, 1 + frame % 2, frame), range(1, 7)))

    before = all_frames()
    assert len(set(before[at : at + 48] for at in range(0, len(before), 48))) > 6
    assert forked(all_frames) == before
    assert all_frames() == before
    assert b"".join(picture.light.tobytes() for picture in turning.frames(1e-2)) == before


def _frame(number: int) -> bytes:
    signal.alarm(SECONDS // 2)  # of this process; without a handler it kills
    scene = ball(animation=marbles.Turntable(frames=6), camera=marbles.Orbit(target=(0, 0.7, 0), radius=10))
    return light(scene, frame=number)


@pytest.mark.parametrize("method", ["fork", "spawn"])
def test_multiprocessing_renders(method: str) -> None:
    expected = [_frame(number) for number in range(1, 7)]
    signal.alarm(SECONDS)
    with multiprocessing.get_context(method).Pool(3) as pool:
        assert pool.map_async(_frame, range(1, 7)).get(timeout=SECONDS // 2) == expected


def test_threads_of_python_render_at_once() -> None:
    scenes = [ball(), ball(ambient=0.3)]
    expected = [light(scene) for scene in scenes]
    start = threading.Barrier(8)

    def render(number: int) -> list[bytes]:
        start.wait(SECONDS)
        return [light(scenes[number % 2], threads) for threads in (None, 1, 2, None)]

    with ThreadPoolExecutor(8) as pool:
        found = [future.result(SECONDS) for future in [pool.submit(render, number) for number in range(8)]]
    assert found == [[expected[number % 2]] * 4 for number in range(8)]


def test_frames_belong_to_the_process_that_began_them(turning: marbles.Scene) -> None:
    expected = [picture.light.tobytes() for picture in turning.frames(1e-2)]
    frames = turning.frames(1e-2)
    found = [next(frames).light.tobytes()]

    def go_on() -> bytes:
        with frames:
            try:
                next(frames)
            except marbles.RenderError as error:
                return str(error).encode()
        return b"no error"

    # Its threads are those of the parent, so it may neither wait for their pictures nor for their end.
    assert b"another process" in forked(go_on)
    assert found + [picture.light.tobytes() for picture in frames] == expected

    dropped = [turning.frames(1e-2)]

    def drop() -> bytes:
        dropped.clear()
        return light(turning, frame=1)

    assert forked(drop) == expected[0]
    assert [picture.light.tobytes() for picture in dropped[0]] == expected
