"""The examples run, and find what is true."""

from __future__ import annotations

import importlib.util
import sys
from collections.abc import Callable
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest
from conftest import ROOT

FOLDER = ROOT / "crates" / "python" / "examples"


def example(name: str) -> ModuleType:
    """The module of an example."""
    spec = importlib.util.spec_from_file_location(name, FOLDER / f"{name}.py")
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules[name] = module  # data classes look for their module there
    try:
        spec.loader.exec_module(module)
    finally:
        del sys.modules[name]
    return module


@pytest.fixture(autouse=True)
def _in_an_empty_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)


@pytest.fixture
def without(monkeypatch: pytest.MonkeyPatch) -> Callable[[ModuleType], None]:
    """Lets an example find no other packages."""
    return lambda module: monkeypatch.setattr(module, "find_spec", lambda name: None)


def check_png(path: Path) -> None:
    assert path.read_bytes().startswith(b"\x89PNG")


def test_every_example_is_tested_here() -> None:
    tests = [name.removeprefix("test_") for name in globals() if name.startswith("test_")]
    for path in FOLDER.glob("*.py"):
        assert any(name.startswith(path.stem) for name in tests), path


def test_photometric_stereo() -> None:
    result = example("photometric_stereo").main()
    assert result.pixels > 10_000
    assert result.off_mean_normal <= result.claimed < 1e-3
    assert result.off_center > 1e-3  # why the truth is `mean_normal`
    assert result.albedo < 1e-6


def test_light_from_shiny_ball() -> None:
    module = example("light_from_shiny_ball")
    random = np.random.default_rng(seed=7)
    others = random.normal(size=(8, 3))
    others[:, 2] = -0.3 - np.abs(others[:, 2])
    for toward in (module.TOWARD, *others):
        result = module.main(toward)
        assert result.off_brightest <= result.bound_brightest < 2, toward
        assert result.off_fit < 2e-3, toward
        assert result.claimed_fit < 1e-4, toward


def test_derivative() -> None:
    for result in example("derivative").main():
        assert abs(result.value - result.truth) <= result.claimed + result.truncated
        assert result.claimed + result.truncated < 1e-3 * abs(result.truth)


def test_referee() -> None:
    result = example("referee").main()
    if result is None:
        pytest.skip("mitsuba cannot be imported")
    # Three standard deviations, found from 16 runs, are exceeded in about one of a hundred pixels by chance.
    assert result.beyond <= 0.01 * result.pixels
    assert 0.8 * result.noise <= result.rms <= 1.2 * result.noise
    assert result.mean < 2e-4
    # The referee would notice a percent of light.
    assert result.beyond_darker > 0.2 * result.pixels


def test_referee_without_mitsuba(without: Callable[[ModuleType], None], capsys: pytest.CaptureFixture[str]) -> None:
    module = example("referee")
    without(module)
    assert module.main() is None
    assert capsys.readouterr().out == "mitsuba is not installed: nothing to referee\n"


def test_simulation_movie(tmp_path: Path) -> None:
    frames, error = example("simulation_movie").main(tmp_path, frames=5)
    assert frames == 5 and 0 < error <= 1e-2
    names = sorted(path.name for path in tmp_path.glob("*.png"))
    assert names == [f"balls.{frame:04}.png" for frame in range(1, 6)]
    check_png(tmp_path / names[-1])
    assert (tmp_path / "balls.gif").exists() == (importlib.util.find_spec("PIL") is not None)


def test_simulation_movie_falls_and_stays_in_its_box() -> None:
    module = example("simulation_movie")
    simulation = module.Simulation(module.BALLS)
    height = simulation.center[:, 1].mean()
    for _ in range(module.FRAMES * module.STEPS):
        simulation.step()
    assert simulation.center[:, 1].mean() < height - 1
    assert (simulation.center[:, 1] > 0).all()
    assert (np.abs(simulation.center[:, [0, 2]]) < module.HALF).all()


def test_simulation_movie_without_pillow(without: Callable[[ModuleType], None], tmp_path: Path) -> None:
    module = example("simulation_movie")
    without(module)
    assert module.main(tmp_path, frames=1)[0] == 1
    assert [path.name for path in tmp_path.iterdir()] == ["balls.0001.png"]


def test_error_map() -> None:
    result = example("error_map").main()
    assert result.over == 0 and 0 < result.median < result.largest <= 1e-3
    assert 0.5 < result.bounds < 1
    if importlib.util.find_spec("matplotlib"):
        check_png(Path("error_map.png"))


def test_error_map_without_matplotlib(without: Callable[[ModuleType], None]) -> None:
    module = example("error_map")
    without(module)
    assert module.main().over == 0
    assert not Path("error_map.png").exists()


def test_many_spheres(tmp_path: Path) -> None:
    module = example("many_spheres")
    picture = module.main(tmp_path / "a.png")
    assert module.COUNT == 100_000
    assert picture.size == (640, 640) and picture.over == 0 and picture.largest_error <= 1e-2
    check_png(tmp_path / "a.png")
