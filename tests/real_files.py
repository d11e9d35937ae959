"""Checks that marbles renders files of other programs as they are.

Usage: real_files.py MARBLES FOLDER [--most MEGABYTES] [--write PAGE]

Downloads the source packages listed in `real_files.txt` from the registry that pip uses, unless they are in FOLDER already, and
renders a small picture of each file in the list. With --most, it skips larger packages. With --write, it writes the results
as a page of the documentation. It exits with 1 if a file is refused and the list does not expect that, or if a message does not
say where the fault is.
"""

import argparse
import io
import json
import os
import re
import subprocess
import sys
import tarfile
import urllib.parse
import urllib.request
from pathlib import Path

LIST = Path(__file__).with_suffix(".txt")
SCENE = """(image: (width: 48, height: 32), lens: Fov(30), camera: Frame(), ambient: 0.3,
lights: [Directional(toward: (1, 2, -1))], clouds: [(file: "table{ending}"{fields})])"""
PAGE = """# Files from other programs

This page lists files from other programs, and shows which of them marbles renders as they are. The files come from the source
packages of {packages} programs. marbles renders {rendered} of {files} files without any change. For the others, the last column
shows the error message.

To show one of these files, put its name into a scene file as `clouds: [(file: "NAME")]`. Some files need additional fields,
given in the third column, because plain points have no radii, and coarse-grained models have no elements.

`tests/real_files.py` renders the files, and writes this page.

| package | file | additional fields | spheres and radii, or message |
|---|---|---|---|
{rows}
"""


def registry() -> str:
    """The address that pip asks for packages."""
    command = [sys.executable, "-m", "pip", "config", "get", "global.index-url"]
    configured = subprocess.run(command, capture_output=True, text=True, check=False).stdout.strip()
    if configured or "PIP_INDEX_URL" in os.environ:
        return configured or os.environ["PIP_INDEX_URL"]
    from pip._internal.models.index import PyPI

    return PyPI.simple_url


def links(index: str, name: str) -> dict[str, tuple[str, int]]:
    """The addresses and sizes of a package's files; an unknown size is 0."""
    accept = "application/vnd.pypi.simple.v1+json, text/html;q=0.5"
    request = urllib.request.Request(f"{index.rstrip('/')}/{name}/", headers={"Accept": accept})
    with urllib.request.urlopen(request, timeout=30) as response:
        text, base = response.read().decode(), response.geturl()
    if text.lstrip().startswith("{"):
        files = json.loads(text)["files"]
        return {file["filename"]: (urllib.parse.urljoin(base, file["url"]), file.get("size") or 0) for file in files}
    found = re.finditer(r'<a[^>]*href="([^"]+)"[^>]*>([^<]+)</a>', text)
    return {match[2]: (urllib.parse.urljoin(base, match[1]), 0) for match in found}


def fetch(index: str, package: str, paths: list[str], folder: Path, most: float) -> bool:
    """Puts the files of a package into the folder. Returns False if the package is too large."""
    missing = [path for path in paths if not (folder / path).exists()]
    if not missing:
        return True
    name = package.rsplit("-", 1)[0].replace("_", "-")
    address, size = links(index, name)[f"{package}.tar.gz"]
    if not size:
        with urllib.request.urlopen(urllib.request.Request(address, method="HEAD"), timeout=30) as head:
            size = int(head.headers.get("Content-Length") or 0)
    if size > most * 1e6:
        return False
    with urllib.request.urlopen(address, timeout=300) as response:
        archive = tarfile.open(fileobj=io.BytesIO(response.read()))
    for path in missing:
        (folder / path).parent.mkdir(parents=True, exist_ok=True)
        (folder / path).write_bytes(archive.extractfile(path).read())
    return True


def render(marbles: str, table: Path, fields: str) -> tuple[bool, str]:
    """Renders a table. Returns whether it succeeded, and the spheres or the message."""
    ending = "".join(table.suffixes[-2:] if table.suffix in (".gz", ".zst", ".bz2", ".xz") else table.suffixes[-1:])
    link, scene = table.parent / f"table{ending}", table.parent / "table.ron"
    link.unlink(missing_ok=True)
    link.symlink_to(table)
    scene.write_text(SCENE.format(ending=ending, fields=fields and ", " + fields))
    output = table.parent / "table.png"
    command = [marbles, "render", str(scene), "-o", str(output), "--samples", "2"]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode == 0:
        command = [marbles, "check", str(scene)]
        check = subprocess.run(command, capture_output=True, text=True, check=True).stdout
        return True, next(line for line in check.splitlines() if line.startswith("spheres"))[12:]
    message = done.stderr.splitlines()[0].removeprefix("marbles: ")
    return False, message.replace(f"{link}", table.name)


def main() -> None:
    parser = argparse.ArgumentParser()
    parser.add_argument("marbles")
    parser.add_argument("folder", type=Path)
    parser.add_argument("--most", type=float, default=float("inf"))
    parser.add_argument("--write", type=Path)
    arguments = parser.parse_args()
    packages: dict[str, list[tuple[str, str, str]]] = {}
    for line in LIST.read_text().splitlines():
        path, fields, *refused = line.split("\t")
        packages.setdefault(path.split("/")[0], []).append((path, fields, "".join(refused)))
    index, rows, rendered, wrong, left_out = registry(), [], 0, [], 0
    for package, files in packages.items():
        if not fetch(index, package, [path for path, _, _ in files], arguments.folder, arguments.most):
            left_out += 1
            continue
        for path, fields, refused in files:
            is_rendered, text = render(arguments.marbles, (arguments.folder / path).resolve(), fields)
            rendered += is_rendered
            if is_rendered == bool(refused) or not is_rendered and "expected" not in text:
                wrong.append(f"{path}: {text}")
            shown = path.split("/", 1)[1]
            cells = [package, f"`{shown}`", f"`{fields}`" if fields else "", text.replace("|", "\\|")]
            rows.append("| " + " | ".join(cells) + " |")
    if arguments.write:
        counts = {"packages": len(packages) - left_out, "rendered": rendered, "files": len(rows)}
        arguments.write.write_text(PAGE.format(rows="\n".join(rows), **counts))
    print(f"{rendered} of {len(rows)} files of {len(packages) - left_out} packages are rendered")
    if wrong:
        sys.exit("\n".join(wrong))


if __name__ == "__main__":
    try:
        main()
    except OSError as error:
        print(f"skipped: no registry: {error}")
