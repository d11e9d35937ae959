"""The interface that the comparison has for every program."""

import resource
import subprocess
import time
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from compared.scenes import Scene


@dataclass(frozen=True)
class Method:
    """A way to render a picture, with settings from coarse to fine."""

    name: str
    command: str
    """The words that matter of the command line, for readers."""

    settings: list
    samples: list[float]
    """The relative work of each setting, by which its time is foretold."""

    labels: list[str]


@dataclass(frozen=True)
class Rendered:
    picture: np.ndarray
    """Linear light, height × width × 3."""

    seconds: float
    """The time of rendering alone, without the time in which others had the processor."""


class Program:
    """A program that can render the scenes with one thread."""

    name: str
    version: str
    methods: list[Method]

    def render(self, scene: Scene, method: Method, setting, folder: Path) -> Rendered:
        raise NotImplementedError


def grids(sides: list[int]) -> dict:
    """The settings of a method that takes a grid of samples in every pixel."""
    return {"settings": sides, "samples": [side**2 for side in sides], "labels": [f"{side} × {side}" for side in sides]}


@dataclass(frozen=True)
class Process:
    """A process that has ended."""

    printed: str
    wall: float
    processor: float
    """The seconds in which it had a processor."""


def run(command: list[str], folder: Path) -> Process:
    """Runs a command in a folder."""
    start, before = time.perf_counter(), resource.getrusage(resource.RUSAGE_CHILDREN)
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
    wall, after = time.perf_counter() - start, resource.getrusage(resource.RUSAGE_CHILDREN)
    if done.returncode != 0:
        raise RuntimeError(f"{' '.join(command)}: {done.stdout}{done.stderr}")
    processor = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    return Process(done.stdout + done.stderr, wall, processor)


class Clock:
    """Time in which this process had a processor, of calls that use one thread."""

    def __init__(self):
        self.seconds = 0.0

    def __enter__(self):
        self.wall, self.processor = time.perf_counter(), time.process_time()

    def __exit__(self, *_):
        self.seconds += min(time.perf_counter() - self.wall, time.process_time() - self.processor)


def read_ppm(path: Path) -> np.ndarray:
    """The numbers of a picture with 16 bits for each, from 0 to 1."""
    data = path.read_bytes()
    fields, at = [], 0
    while len(fields) < 4:
        end = min(place for place in (data.find(b" ", at), data.find(b"\n", at)) if place >= 0)
        if data[at : at + 1] == b"#":
            end = data.index(b"\n", at)
        elif end > at:
            fields.append(data[at:end])
        at = end + 1
    width, height, most = map(int, fields[1:])
    assert fields[0] == b"P6" and most == 65535, fields
    return np.frombuffer(data, ">u2", offset=at).reshape(height, width, 3) / 65535.0


def averaged(picture: np.ndarray, grid: int) -> np.ndarray:
    """The means of squares of `grid` × `grid` pixels."""
    height, width, channels = picture.shape
    return picture.reshape(height // grid, grid, width // grid, grid, channels).mean(axis=(1, 3))
