"""The same bits as those of the command, and files that both read and write."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import marbles
import numpy as np
import pytest
from conftest import ROOT, SCENES, ball, command, same

NAMES = ("depth", "normal", "position", "albedo", "id", "mask")


@pytest.fixture(scope="session")
def rendered(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder of the pictures of all scenes that the command rendered."""
    folder = tmp_path_factory.mktemp("command")
    command(
        "render", *SCENES, "--size", "40x30", "--frames", 1, "--tolerance", 1e-2, "--error-channel", "--channels",
        ",".join(NAMES), "-q", "-o", folder / "{scene}.npz",
    )  # fmt: skip
    return folder


def check_same(picture: marbles.Picture, file: Path) -> None:
    """Compares a picture with the arrays of a file, bit for bit."""
    with np.load(file) as arrays:
        assert set(arrays.files) == {"light", "error", *picture.channels}
        for name in arrays.files:
            assert same(picture[name], arrays[name]), name


def test_there_are_scenes() -> None:
    assert len(SCENES) > 20


@pytest.mark.filterwarnings("ignore::marbles.SceneWarning")
@pytest.mark.parametrize("scene", SCENES, ids=lambda path: path.stem)
def test_pictures_are_those_of_the_command(scene: Path, rendered: Path) -> None:
    picture = marbles.load(scene).render(1e-2, frame=1, size=(40, 30), channels=NAMES)
    check_same(picture, rendered / f"{scene.stem}.npz")


def test_other_options_are_those_of_the_command(tmp_path: Path) -> None:
    file = ROOT / "scenes" / "first.ron"
    scene = marbles.load(file)
    command(
        "render", file, "--size", "60x40", "--region", "10,5,30,20", "--alpha", "--channels", "mean_normal,coverage_id,depth",
        "--depth", "ray", "--axes", "camera-opencv", "--error-channel", "-o", tmp_path / "a.npz",
    )  # fmt: skip
    picture = scene.render(
        size=(60, 40), region=(10, 5, 30, 20), alpha=True, channels=("mean_normal", "coverage_id", "depth"), depth="ray",
        axes="camera-opencv",
    )  # fmt: skip
    check_same(picture, tmp_path / "a.npz")
    command("render", file, "--size", "60x40", "--samples", 3, "--error-channel", "-o", tmp_path / "b.npz")
    check_same(scene.render(samples=3, size=(60, 40)), tmp_path / "b.npz")
    command("render", file, "--size", "60x40", "--per-light", "--error-channel", "-o", tmp_path / "c.npz")
    parts = scene.render(size=(60, 40), per_light=True).per_light
    assert len(parts) == 2
    for name, part in parts.items():
        check_same(part, tmp_path / f"c.{name}.npz")


@pytest.mark.parametrize(
    ("name", "options", "flags"),
    [
        ("a.png", {}, []),
        ("a.png", {"bits": 16, "exposure": -1.0}, ["--bits", 16, "--exposure", -1]),
        ("a.png", {"linear": True}, ["--linear"]),
        ("a.exr", {"error": True}, ["--error-channel"]),
        ("a.exr", {"float": True}, ["--float"]),
        ("a.tif", {}, []),
        ("a.npy", {}, []),
        ("a.npz", {"error": True}, ["--error-channel"]),
    ],
)
def test_saved_pictures_are_the_files_of_the_command(name: str, options: dict[str, object], flags: list[object], tmp_path: Path) -> None:  # fmt: skip
    file = ROOT / "scenes" / "first.ron"
    (tmp_path / "command").mkdir()
    command("render", file, "--size", "60x40", "-q", "-o", tmp_path / "command" / name, *flags)
    picture = marbles.load(file).replace(image={"width": 60, "height": 40}).render()
    assert marbles.compare(picture, marbles.load(file).render(size=(60, 40))).max == 0
    marbles.load(file).render(size=(60, 40)).save(tmp_path / name, **options)  # type: ignore[arg-type]
    assert (tmp_path / name).read_bytes() == (tmp_path / "command" / name).read_bytes()
    assert [path.name for path in tmp_path.iterdir() if path.is_file()] == [name]


def test_sidecars_are_those_of_the_command(tmp_path: Path) -> None:
    file = ROOT / "scenes" / "first.ron"
    (tmp_path / "command").mkdir()
    command("render", file, "--size", "60x40", "-q", "--sidecar", "-o", tmp_path / "command" / "a.png")
    marbles.load(file).render(size=(60, 40)).save(tmp_path / "a.png", sidecar=True)
    assert (tmp_path / "a.json").read_bytes() == (tmp_path / "command" / "a.json").read_bytes()


def test_pictures_cannot_be_saved_in_other_formats(tmp_path: Path) -> None:
    picture = ball().render(1e-2)
    for name, options in (("a.jpg", {}), ("a", {}), ("a.npy", {"bits": 16}), ("a.png", {"bits": 12})):
        with pytest.raises(ValueError):
            picture.save(tmp_path / name, **options)  # type: ignore[arg-type]
    with pytest.raises((OSError, marbles.RenderError), match="no such"):
        picture.save(tmp_path / "no such folder" / "a.png")
    assert list(tmp_path.iterdir()) == []


def check_saved(scene: marbles.Scene, file: Path) -> None:
    """Compares a scene in memory with the picture that the command makes of its file."""
    out = file.with_suffix(".npz")
    command("render", file, "--tolerance", 1e-2, "--frames", 1, "--error-channel", "-q", "-o", out)
    check_same(scene.render(1e-2, frame=1), out)


def test_saved_scenes_are_the_same_for_the_command(tmp_path: Path) -> None:
    random = np.random.default_rng(3)
    centers = random.uniform(-2, 2, (50, 3))
    first = marbles.Spheres(centers, random.uniform(0.1, 0.4, 50), color=random.random((50, 3)), material="candy")
    second = marbles.Spheres(centers.astype(np.float32) + 1, 0.2, value=centers[:, 0], colormap="Inferno")
    scene = ball(spheres=[first, {"center": (0, -1000, 0), "radius": 998}, second])
    file = tmp_path / "grains.ron"
    scene.save(file)
    names = {"grains.ron", "grains_spheres.npy", "grains_spheres_2.npy"}
    assert {path.name for path in tmp_path.iterdir()} == names
    check_saved(scene, file)
    again = marbles.load(file)
    assert same(again.render(1e-2).light, scene.render(1e-2).light)
    # New arrays do not take the place of the file that the scene still shows.
    more = again.replace(spheres=marbles.Spheres([(0, 3, 0)], 0.3))
    more.save(file)
    check_saved(more, file)
    assert len(marbles.load(file).spheres_table()["x"]) == 101


@pytest.mark.filterwarnings("ignore::marbles.SceneWarning")
def test_saved_scenes_find_their_tables(tmp_path: Path) -> None:
    scene = marbles.load(ROOT / "scenes" / "cluster.ron").replace(image={"width": 40, "height": 30})
    (tmp_path / "below").mkdir()
    file = tmp_path / "below" / "cluster.ron"
    scene.save(file)
    check_saved(scene, file)
    back = marbles.load(file)
    back.save(tmp_path / "up.ron")
    check_saved(scene, tmp_path / "up.ron")
    assert [path.name for path in (tmp_path / "below").iterdir() if path.suffix == ".ron"] == ["cluster.ron"]


@pytest.mark.filterwarnings("ignore::marbles.SceneWarning")
def test_a_scene_that_cannot_be_saved_leaves_nothing(tmp_path: Path) -> None:
    scene = ball(spheres=marbles.Spheres([(0, 0, 0)]))
    (tmp_path / "a.ron").mkdir()
    with pytest.raises(OSError):
        scene.save(tmp_path / "a.ron")
    assert {path.name for path in tmp_path.iterdir()} <= {"a.ron", "a_spheres.npy"}
    with pytest.raises(OSError):
        scene.save(tmp_path / "no such folder" / "a.ron")


@pytest.mark.skipif(not hasattr(os, "umask"), reason="permissions of POSIX")
def test_saved_scenes_have_usual_permissions(tmp_path: Path) -> None:
    ball().save(tmp_path / "a.ron")
    (tmp_path / "b.ron").write_text("")
    assert (tmp_path / "a.ron").stat().st_mode == (tmp_path / "b.ron").stat().st_mode


@pytest.mark.filterwarnings("ignore::marbles.SceneWarning")
def test_tables_of_particles_are_loaded(tmp_path: Path) -> None:
    table = ROOT / "scenes" / "salt.xyz"
    command("render", table, "--samples", 1, "--error-channel", "-q", "-o", tmp_path / "a.npz")
    scene = marbles.load(table)
    check_same(scene.render(samples=1), tmp_path / "a.npz")
    scene.replace(image={"width": 40, "height": 30}).save(tmp_path / "salt.ron")
    check_saved(scene.replace(image={"width": 40, "height": 30}), tmp_path / "salt.ron")


def test_the_command_has_its_exit_codes(tmp_path: Path) -> None:
    def code(*arguments: object) -> int:
        line = [sys.executable, "-m", "marbles", *map(str, arguments)]
        return subprocess.run(line, capture_output=True, check=False, timeout=60).returncode

    assert code("--help") == 0
    assert code("render", tmp_path / "nothing.ron") in (1, 2)
    assert code("nonsense") == 2


def test_data_sets_are_written(tmp_path: Path) -> None:
    lights = [marbles.Directional(toward) for toward in ((1, 1, -2), (-1, 1, -2), (0, -1, -2))]
    ball(lights=lights, ambient=0).save(tmp_path / "a.ron")
    assert marbles.dataset(tmp_path / "a.ron", tmp_path / "out", layout="diligent", size=(24, 16), tolerance=1e-2)
    assert (tmp_path / "out" / "filenames.txt").read_text().split() == ["001.png", "002.png", "003.png"]
    with pytest.raises(marbles.RenderError, match="no such file"):
        marbles.dataset(tmp_path / "nothing.ron", tmp_path / "other", layout="diligent")


@pytest.mark.skipif(sys.platform == "win32", reason="signals of POSIX")
def test_ctrl_c_stays_an_exception_after_a_data_set(tmp_path: Path) -> None:
    lights = [marbles.Directional(toward) for toward in ((1, 1, -2), (-1, 1, -2), (0, -1, -2))]
    ball(lights=lights, ambient=0).save(tmp_path / "a.ron")
    program = """
import marbles, os, signal, sys, time
marbles.dataset(sys.argv[1], sys.argv[2], layout="diligent", size=(24, 16), tolerance=1e-2)
for _ in range(3):
    try:
        os.kill(os.getpid(), signal.SIGINT)
        time.sleep(1)
    except KeyboardInterrupt:
        time.sleep(0.3)
print("alive")
"""
    line = [sys.executable, "-c", program, str(tmp_path / "a.ron"), str(tmp_path / "out")]
    done = subprocess.run(line, capture_output=True, text=True, timeout=60, check=False)
    assert done.stdout.endswith("alive\n"), done.stderr
