"""What other programs take to the same errors as marbles: pictures of the same scenes, compared with exact values.

Usage: comparison.py --marbles PROGRAM [--write docs/comparison.md] [--seconds 10] [--runs 3] [--side 300]

Needs NumPy. Programs that are not installed are left out: POV-Ray (`povray`), Tachyon (`tachyon`), Mitsuba 3 (the Python
package `mitsuba`, and LLVM), Embree 3 (`libembree3.so.3`). Each renders with one thread. Settings whose picture is expected to
take longer than --seconds are left out. With --write the results become the measured part of a page. Fails where
the pictures do not agree.
"""

import argparse
import os
import platform
import random
import subprocess
import tempfile
from pathlib import Path

import numpy as np

from compared import accuracy, embree, mitsuba, povray, scenes, tachyon
from compared.accuracy import Measured, Reference
from compared.marbles import Marbles
from compared.program import Method, Program

REPOSITORY = Path(__file__).resolve().parent.parent
# What marbles is built from.
SOURCES = ["crates", "Cargo.toml", "Cargo.lock"]
HEAD, END = "<!-- measured: comparison -->\n", "<!-- end -->\n"
RMS_GOALS, LARGEST_GOALS = [1e-2, 1e-3, 1e-4], [1e-1, 1e-2, 1e-3]
# Shorter runs are repeated more often.
SHORT, MORE = 0.3, 3
# What pictures may differ in besides noise: a wrong unit of light, or half a pixel, is more.
LIGHT, SHIFT = 1e-2, 2e-2
# The largest RMS difference of the reference to an average over many samples.
UNPROVED = 2e-4
# Parts of the picture that POV-Ray renders with many samples, in pixels, and the samples.
WINDOWS, WINDOW, GRIDS = 12, 8, [8, 32, 128]


def installed(path: str) -> list[Program]:
    others = [povray.PovRay.find(), tachyon.Tachyon.find(), mitsuba.Mitsuba.find(), embree.Embree.find()]
    return [Marbles(path), *(program for program in others if program)]


def measure(scene, programs: list[Program], reference: Reference, folder: Path, options) -> dict:
    """All settings of all methods, in turns: what is measured of each method, and its finest picture's alignment."""
    rows: dict[str, list[Measured]] = {method.name: [] for program in programs for method in program.methods}
    alignment = {}
    turns = [(program, method, index) for program in programs for method in program.methods for index in range(9)]
    turns.sort(key=lambda turn: turn[2])
    for turn in range(options.runs):
        for program, method, index in turns:
            measured = rows[method.name]
            if index >= (len(method.settings) if turn == 0 else len(measured)):
                continue
            if turn == 0 and index > 0 and foretold(method, measured, index) > options.seconds:
                continue
            rendered = program.render(scene, method, method.settings[index], folder)
            if turn == 0:
                measured.append(Measured(method.labels[index], *reference.errors(rendered.picture)))
                alignment[method.name] = reference.alignment(rendered.picture)
            measured[index].times.append(rendered.seconds)
            for _ in range(MORE - 1 if rendered.seconds < SHORT else 0):
                again = program.render(scene, method, method.settings[index], folder)
                measured[index].times.append(again.seconds)
        print(f"{scene.title}: round {turn + 1} of {options.runs}", flush=True)
    return {"rows": rows, "alignment": alignment}


def foretold(method: Method, measured: list[Measured], index: int) -> float:
    """The time that a setting is expected to take; infinite after one that was left out."""
    if len(measured) < index:
        return float("inf")
    # What a picture takes however few samples it has is not multiplied.
    fixed = measured[0].seconds if index > 1 else measured[-1].seconds
    return fixed + (measured[-1].seconds - fixed) * method.samples[index] / method.samples[index - 1]


def check_reference(scene, program: povray.PovRay, reference: Reference, folder: Path) -> list[tuple[float, float]]:
    """How far POV-Ray's averages over many samples are from the reference, in parts that are not of one color."""
    places = range(0, scene.side - WINDOW + 1, WINDOW)
    parts = [(col, row) for row in places for col in places]
    cut = {part: reference.picture[part[1] :][:WINDOW, part[0] :][:, :WINDOW] for part in parts}
    chosen = random.Random(3).sample([part for part in parts if np.ptp(cut[part], axis=(0, 1)).max() > 0.1], WINDOWS)
    differences = []
    for grid in GRIDS:
        off = [program.window(scene, (*part, WINDOW), grid, folder).picture - cut[part] for part in chosen]
        off = np.array(off)
        differences.append((float(np.sqrt((off**2).mean())), float(np.abs(off).max())))
    return differences


def seconds(time: float) -> str:
    if time >= 100:
        return f"{time:,.0f} s"
    if time >= 1:
        return f"{time:.1f} s"
    return f"{1e3 * time:.0f} ms" if time >= 0.01 else f"{1e3 * time:.1f} ms"


def power(number: float) -> str:
    return f"{number:.0e}".replace("e-0", "e-")


def cells(rows: list[Measured]) -> list[str]:
    """The time to each error, with the setting that reaches it."""
    goals = [(goal, "rms") for goal in RMS_GOALS] + [(goal, "largest") for goal in LARGEST_GOALS]
    found = [accuracy.time_to(goal, rows, error) for goal, error in goals]
    return [f"{seconds(to[0])} ({to[1]})" if to else "-" for to in found]


def table(head: list[str], rows: list[list[str]], left: int = 1) -> str:
    rule = ["---"] * left + ["--:"] * (len(head) - left)
    return "\n".join("| " + " | ".join(row) + " |" for row in [head, rule, *rows]) + "\n"


def commit() -> str:
    """The commit that changed marbles last, and whether it has changed since."""

    def git(*words: str) -> str:
        return subprocess.run(["git", *words], cwd=REPOSITORY, capture_output=True, text=True, check=True).stdout.strip()

    changed = git("status", "--porcelain", "--", *SOURCES)
    return git("log", "-1", "--format=%h (%cs)", "--", *SOURCES) + (" + changes" if changed else "")


def processor() -> str:
    try:
        flags = set(Path("/proc/cpuinfo").read_text().split())
    except OSError:
        flags = set()
    levels = {"avx512f": "AVX-512", "avx2": "AVX2", "asimd": "NEON"}
    level = next((f" with {name}" for flag, name in levels.items() if flag in flags), "")
    return f"{platform.machine()}{level}, {os.cpu_count()} cores"


def page(measured: str, programs: list[Program], results: list[tuple], options) -> str:
    """The measured part of the page."""
    text = f"Measured at {measured}, on {processor()}; medians of at least {options.runs} runs; "
    text += f"settings that would take longer than {options.seconds:g} s are left out.\n\n"
    rows = []
    for program in programs:
        for method in program.methods:
            aligned = [result["alignment"][method.name] for _, result, _ in results]
            light = max(abs(factor - 1) for factor, _ in aligned)
            shift = max(shift for _, shift in aligned)
            rows.append([method.name, program.version, f"`{method.command}`", power(light), power(shift)])
    text += table(["method", "version", "command", "light", "shift"], rows, left=3)
    for scene, result, differences in results:
        text += f"\n### {scene.title}\n\n"
        head = [f"RMS {power(goal)}" for goal in RMS_GOALS] + [f"largest {power(goal)}" for goal in LARGEST_GOALS]
        text += table(["method", *head], [[name, *cells(measured)] for name, measured in result["rows"].items()])
        if differences:
            shares = ", ".join(f"{power(rms)} ({power(largest)})" for rms, largest in differences)
            text += f"\nPOV-Ray with {', '.join(map(str, GRIDS))} samples per side of a pixel, against the reference: {shares}.\n"
    return text


def main() -> None:
    parser = argparse.ArgumentParser()
    parser.add_argument("--marbles", required=True)
    parser.add_argument("--write", type=Path)
    parser.add_argument("--seconds", type=float, default=10)
    parser.add_argument("--runs", type=int, default=3)
    parser.add_argument("--side", type=int, default=300)
    options = parser.parse_args()
    if options.write:
        before, rest = options.write.read_text().split(HEAD)
        after = rest.split(END, 1)[1]
    measured, programs = commit(), installed(options.marbles)
    results = []
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for scene in [scenes.ball(options.side), scenes.hill(options.side), scenes.particles(options.side)]:
            exact, claimed = programs[0].with_errors(scene, f"--tolerance={accuracy.REFERENCE_ERROR}", folder)
            reference = Reference(exact.picture, claimed <= accuracy.REFERENCE_ERROR)
            print(f"{scene.title}: the reference knows all pixels but {(~reference.is_known).sum()}", flush=True)
            judges = [program for program in programs if isinstance(program, povray.PovRay)]
            differences = [check_reference(scene, judge, reference, folder) for judge in judges]
            results.append((scene, measure(scene, programs, reference, folder, options), sum(differences, [])))
    text = page(measured, programs, results, options)
    print(text)
    if options.write:
        options.write.write_text(f"{before}{HEAD}\n{text}\n{END}{after}")
    for scene, result, differences in results:
        if differences and differences[-1][0] > UNPROVED:
            raise SystemExit(f"{scene.title}: POV-Ray is {differences[-1][0]} from the reference")
        for name, (light, shift) in result["alignment"].items():
            if abs(light - 1) > LIGHT or shift > SHIFT:
                raise SystemExit(f"{scene.title}: {name} shows another picture: light × {light}, moved by {shift} pixels")


main()
