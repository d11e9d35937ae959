"""Several frames, interruptions, threads, memory."""

from __future__ import annotations

import _thread
import gc
import threading
import time
import tracemalloc

import marbles
import pytest
from conftest import ball, same

# A picture that takes much longer than a test may.
SLOW = {"tolerance": 1e-9, "size": (2000, 2000)}


def test_frames_are_those_of_render(turning: marbles.Scene) -> None:
    assert turning.frame_range == (1, 6)
    pictures = list(turning.frames(1e-2, channels=("depth",)))
    assert [picture.frame for picture in pictures] == [1, 2, 3, 4, 5, 6]
    for picture in pictures:
        single = turning.render(1e-2, frame=picture.frame, channels=("depth",))
        assert same(picture.light, single.light) and same(picture["depth"], single["depth"])
        assert picture.sidecar == single.sidecar
        assert same(picture.camera.R, turning.camera(picture.frame).R)
    assert not same(pictures[0].light, pictures[1].light)


def test_frames_are_chosen(turning: marbles.Scene) -> None:
    assert [picture.frame for picture in turning.frames(1e-2, frames=(5, 2))] == [5, 2]
    assert [picture.frame for picture in turning.frames(1e-2, frames=range(2, 4))] == [2, 3]
    assert list(turning.frames(1e-2, frames=())) == []
    with pytest.raises(ValueError, match=r"frames\[1\]: expected a whole number from 1 to 6, found 7"):
        list(turning.frames(1e-2, frames=(1, 7)))
    with pytest.raises(TypeError, match=r"frames\[1\]: expected a whole number"):
        turning.frames(1e-2, frames=(1, "2"))  # type: ignore[arg-type]
    assert [picture.frame for picture in ball().frames(1e-2)] == [1]


def test_a_loop_may_stop_early(turning: marbles.Scene) -> None:
    for picture in turning.frames(1e-2):
        break
    assert picture.frame == 1
    with turning.frames(1e-2) as frames:
        next(frames)
    frames.close()
    assert list(frames) == []
    start = time.monotonic()
    slow = turning.frames(**SLOW)  # type: ignore[arg-type]
    slow.close()
    dropped = turning.frames(**SLOW)  # type: ignore[arg-type]
    del dropped
    gc.collect()
    assert same(turning.render(1e-2).light, picture.light)
    assert time.monotonic() - start < 10


def test_ctrl_c_ends_a_rendering() -> None:
    scene = ball()
    before = scene.render(1e-2).light
    for _ in range(2):
        timer = threading.Timer(0.4, _thread.interrupt_main)
        start = time.monotonic()
        timer.start()
        with pytest.raises(KeyboardInterrupt):
            scene.render(**SLOW)  # type: ignore[arg-type]
        timer.join()
        assert time.monotonic() - start < 3
    assert same(scene.render(1e-2).light, before)


def test_threads_render_at_once(turning: marbles.Scene) -> None:
    expected = [picture.light for picture in turning.frames(1e-2)]
    found: dict[int, list[bool]] = {}

    def render(number: int) -> None:
        if number % 2:
            found[number] = [same(a.light, b) for a, b in zip(turning.frames(1e-2), expected, strict=True)]
        else:
            found[number] = [same(turning.render(1e-2, frame=frame).light, expected[frame - 1]) for frame in range(1, 7)]

    threads = [threading.Thread(target=render, args=(number,)) for number in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert found == {number: [True] * 6 for number in range(4)}


def test_python_runs_while_a_picture_is_rendered() -> None:
    scene = ball()
    counted = 0
    done = threading.Event()

    def render() -> None:
        scene.render(1e-5, size=(400, 300), threads=1)
        done.set()

    thread = threading.Thread(target=render)
    thread.start()
    while not done.is_set() and counted < 10**6:
        counted += 1
        time.sleep(0)
    thread.join()
    assert counted > 10


def resident() -> int:
    """The memory of this process in bytes; 0 where the system does not tell."""
    try:
        with open("/proc/self/statm", encoding="ascii") as file:
            return int(file.read().split()[1]) * 4096
    except OSError:
        return 0


def test_memory_does_not_grow() -> None:
    scene = ball()
    for _ in range(10):
        scene.render(1e-2, channels=("depth", "normal"), size=(100, 80))
    gc.collect()
    before = resident()
    tracemalloc.start()
    for _ in range(100):
        scene.render(1e-2, channels=("depth", "normal"), size=(100, 80))
        ball()
    gc.collect()
    traced, _ = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    # A hundred pictures have 80 MB.
    assert traced < 2_000_000
    assert resident() - before < 30_000_000
