"""Whether lists of frames mean the same to marbles and to Open Job Description, both ways.

Usage: farm_ranges.py, with marbles on the path and openjd installed.
"""

import pathlib
import random
import re
import subprocess
import tempfile

from openjd.model import IntRangeExpr

# It has all frames that are asked for.
SCENE = """(
    image: (width: 9, height: 9),
    lens: Fov(40),
    camera: Free(),
    lights: [Directional(toward: (1, 1, -1))],
    spheres: [(center: (0, 0, 5), radius: 1)],
    animation: Keyframes(frames: (-1000, 1000), keys: [(frame: 1)]),
)
"""


def chunks(scene: str, frames: str, size: int) -> list[str]:
    """The lists that the tasks of a Slurm array get."""
    command = ["marbles", "farm", "slurm", scene, "--quiet", "-o", "#.png"]
    command += [f"--frames={frames}", f"--chunk={size}"]
    script = subprocess.run(command, check=True, capture_output=True, text=True, timeout=60)
    (table,) = re.findall(r"^chunks=\(\n(.*?)^\)", script.stdout, re.DOTALL | re.MULTILINE)
    return table.split()


def expression(numbers: random.Random) -> str:
    """A random range expression; its ranges do not overlap."""
    items = []
    start = numbers.randint(-60, 20)
    for _ in range(numbers.randint(1, 6)):
        last = start + numbers.choice([0, 1, 5, 17])
        step = numbers.choice([1, 1, 2, 3, 40])
        space = numbers.choice(["", "", " "])
        if last == start:
            items.append(f"{space}{start}")
        elif numbers.random() < 0.2:
            items.append(f"{last}{space}-{start}:-{step}")
        elif step == 1:
            items.append(f"{start}-{space}{last}{space}")
        else:
            items.append(f"{start}-{last}:{step}{space}")
        start = last + numbers.randint(1, 9)
    numbers.shuffle(items)
    return ",".join(items)


def main(scene: str) -> None:
    numbers = random.Random(1)
    for _ in range(60):
        text = expression(numbers)
        expected = list(IntRangeExpr.from_str(text))
        ours = [int(frame) for frame in chunks(scene, text, 1)]
        assert sorted(ours) == sorted(expected), (text, ours)
        # What engines hand over is such a text again, and so is what tasks get from us.
        canonical = str(IntRangeExpr.from_list(expected))
        assert [int(frame) for frame in chunks(scene, canonical, 1)] == sorted(expected), canonical
        ours = [list(IntRangeExpr.from_str(part)) for part in chunks(scene, text, 7)]
        assert sorted(sum(ours, [])) == sorted(expected), text
    print("lists of frames mean the same to both: 60 of 60")


with tempfile.TemporaryDirectory() as folder:
    path = pathlib.Path(folder, "scene.ron")
    path.write_text(SCENE)
    main(str(path))
