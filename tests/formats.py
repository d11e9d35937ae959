"""Whether the readers of others find in every kind of file the numbers that marbles computed.

Usage: formats.py FOLDER, with the pictures of `crates/cli/tests/process/readers.rs` in FOLDER, and
numpy, Pillow, imageio, OpenCV and OpenEXR on the path.

The array of doubles is the truth: each other file has to hold it, rounded once to the file's own numbers.
"""

import os
import sys
from pathlib import Path

os.environ["OPENCV_IO_ENABLE_OPENEXR"] = "1"  # read when cv2 is imported

import cv2
import imageio.v3 as iio
import numpy as np
import OpenEXR
from PIL import Image

SCENES = ["color", "grey"]
# More than doubles lose between light and code, and less than anybody would call a difference.
SLACK = 1e-6


def truth(folder: Path, name: str) -> np.ndarray:
    """The light of a picture, height × width × 3, or 4 with alpha."""
    light = np.load(folder / f"{name}.npy")
    assert light.dtype == np.dtype("<f8") and light.flags.c_contiguous, light.dtype
    assert light.shape == (30, 40, 4 if name.endswith("alpha") else 3), light.shape
    mapped = np.load(folder / f"{name}.npy", mmap_mode="r")
    assert np.array_equal(mapped, light)
    error = np.load(folder / f"{name}_error.npy")
    assert error.dtype == np.dtype("<f8") and error.shape == (30, 40), error.shape
    assert 0 < error.max() <= 1e-3, error.max()
    return light


def check_npz(folder: Path, name: str, light: np.ndarray) -> int:
    """All arrays of a picture in one file, under their names."""
    with np.load(folder / f"{name}.npz") as file:
        arrays = dict(file)
    assert list(arrays) == ["light", "error", "depth", "normal", "id"], list(arrays)
    assert np.array_equal(arrays["light"], light)
    assert np.array_equal(arrays["error"], np.load(folder / f"{name}_error.npy"))
    assert arrays["depth"].shape == (30, 40) and arrays["normal"].shape == (30, 40, 3)
    assert arrays["id"].dtype == np.dtype("<u4") and arrays["id"].shape == (30, 40)
    seen = arrays["id"] != 0xFFFF_FFFF
    assert np.array_equal(seen, np.isfinite(arrays["depth"])) and seen.any() and not seen.all()
    lengths = np.linalg.norm(arrays["normal"][seen], axis=1)
    assert np.abs(lengths - 1).max() < 1e-15, lengths
    return 1


def srgb(light: np.ndarray) -> np.ndarray:
    """The sRGB value of linear light."""
    root = 1.055 * np.maximum(light, 0.0031308) ** (1 / 2.4) - 0.055
    return np.where(light <= 0.0031308, 12.92 * light, root)


def codes(light: np.ndarray, kind: str) -> np.ndarray:
    """The exact codes of a picture in a PNG, before they are rounded."""
    most = 255 if kind == "8" else 65535
    colors = light[..., :3]
    if light.shape[2] == 4:
        alpha = light[..., 3:]
        colors = np.divide(colors, alpha, out=np.zeros_like(colors), where=alpha > 0)
    colors = colors.clip(0, 1)
    colors = colors if kind == "linear" else srgb(colors)
    return most * np.concatenate([colors, light[..., 3:]], axis=2)


def check_codes(found: np.ndarray, light: np.ndarray, kind: str, reader: str) -> None:
    """Fails where a code is not the nearest one; gray may stand for three colors."""
    assert found.dtype == (np.uint8 if kind == "8" else np.uint16), (reader, found.dtype)
    exact = codes(light, kind)
    if found.ndim == 2:
        found = found[..., None]
    if found.shape[2] < 3:
        exact = np.concatenate([exact[..., :1], exact[..., 3:]], axis=2)
    assert found.shape == exact.shape, (reader, found.shape, exact.shape)
    assert np.abs(found - exact).max() <= 0.5 + SLACK, (reader, np.abs(found - exact).max())


def rgb(bgr: np.ndarray) -> np.ndarray:
    """Colors in the order of all but OpenCV."""
    return bgr if bgr.ndim == 2 else bgr[..., [2, 1, 0, 3][: bgr.shape[2]]]


def check_png(folder: Path, name: str, light: np.ndarray) -> int:
    count = 0
    for kind in ["8", "16", "linear"]:
        path = folder / f"{name}.{kind}.png"
        with Image.open(path) as image:
            image.load()
            found = np.array(image)
            curve = (image.info.get("srgb"), image.info.get("gamma"))
            assert curve == ((None, 1.0) if kind == "linear" else (0, None)), (path, curve)
            assert len(image.text["Digest"]) == 64
        full = cv2.imread(str(path), cv2.IMREAD_UNCHANGED)
        assert full is not None, path
        full = rgb(full)
        grey_of_three = full.ndim == 3 and np.array_equal(full[..., 0], full[..., 2])
        assert grey_of_three or full.ndim == 2 or name.startswith("color"), full.shape
        check_codes(full, light, kind, f"OpenCV, {path.name}")
        # imageio has OpenCV for what Pillow has no mode for.
        by_opencv = iio.imread(path, plugin="opencv", flags=cv2.IMREAD_UNCHANGED)
        check_codes(by_opencv, light, kind, f"imageio by OpenCV, {path.name}")
        by_pillow = iio.imread(path, plugin="pillow")
        assert np.array_equal(by_pillow, found), path
        if kind == "8" or found.dtype == np.uint16:
            check_codes(found, light, kind, f"Pillow, {path.name}")
        else:
            # Of 16 bit Pillow keeps the upper eight, but for plain gray.
            assert np.array_equal(found, full >> 8), path
        count += 4
    return count


def check_exr(folder: Path, name: str, light: np.ndarray) -> int:
    count = 0
    error = np.load(folder / f"{name}_error.npy")
    for kind, number in [("half", np.float16), ("float", np.float32)]:
        path = folder / f"{name}.{kind}.exr"
        expected = light.astype(number)
        with OpenEXR.File(str(path), separate_channels=True) as file:
            found = {channel: data.pixels for channel, data in file.channels().items()}
            header = dict(file.header())
        names = "RGBA"[: light.shape[2]]
        assert sorted(found) == sorted([*names, "error"]), sorted(found)
        for index, channel in enumerate(names):
            assert found[channel].dtype == number, (path, channel)
            assert np.array_equal(found[channel], expected[..., index]), (path, channel)
        # Errors are rounded up.
        stored = found["error"]
        assert stored.dtype == np.float32
        assert (stored >= error).all() and (np.nextafter(stored, np.float32(-1)) < error).all()
        assert header["error"] == error.max(), (header["error"], error.max())
        assert header["over"] == 0 and 0 < header["bounded_pixels"] <= error.size
        assert header["tolerance"] == np.float32(1e-3)
        check_camera(header, light)

        full = cv2.imread(str(path), cv2.IMREAD_UNCHANGED)
        assert full is not None and full.dtype == np.float32, path
        assert np.array_equal(rgb(full), expected.astype(np.float32)), path
        by_imageio = iio.imread(path, plugin="opencv", flags=cv2.IMREAD_UNCHANGED)
        assert np.array_equal(by_imageio, expected.astype(np.float32)), path
        count += 3
    return count


def check_layers(folder: Path, name: str, light: np.ndarray) -> int:
    """The picture is where it is without layers, and they make it as far as errors and the rounding of floats allow."""
    path = folder / f"{name}.layers.exr"
    expected = light.astype(np.float32)
    with OpenEXR.File(str(path), separate_channels=True) as file:
        found = {channel: data.pixels.astype(float) for channel, data in file.channels().items()}
    layers = ["light-1", "ambient"]
    names = [*"RGBA"[: light.shape[2]], "error"]
    names += [f"{layer}.{channel}" for layer in layers for channel in ["R", "G", "B", "error"]]
    assert sorted(found) == sorted(names), sorted(found)
    error = found["error"] + sum(found[f"{layer}.error"] for layer in layers) + SLACK
    for index, channel in enumerate("RGB"):
        assert np.array_equal(found[channel], expected[..., index]), (path, channel)
        summed = sum(found[f"{layer}.{channel}"] for layer in layers)
        assert (np.abs(summed - found[channel]) <= error).all(), (path, channel)
    assert found["light-1.R"].max() > 1, path
    full = cv2.imread(str(path), cv2.IMREAD_UNCHANGED)
    assert full is not None and np.array_equal(rgb(full), expected), path
    return 1


def check_camera(header: dict, light: np.ndarray) -> None:
    """Fails where the small ball is not seen where the header's camera has its center."""
    if light.shape[2] < 4:
        return
    ball = np.array([4.0, 1.0, 1.0, 1.0])
    x, y, z, _ = ball @ np.array(header["worldToCamera"], dtype=float).reshape(4, 4)
    center, width = header["screenWindowCenter"], header["screenWindowWidth"]
    rows, columns = light.shape[:2]
    col = columns / 2 + columns * (x / z - center[0]) / width
    row = rows / 2 - columns * (y / z - center[1]) / width
    # The only thing in the right half of the picture.
    alpha = light[:, columns // 2 :, 3]
    weights = alpha / alpha.sum()
    seen_col = columns // 2 + (weights.sum(axis=0) * (np.arange(columns // 2) + 0.5)).sum()
    seen_row = (weights.sum(axis=1) * (np.arange(rows) + 0.5)).sum()
    distance = np.hypot(col - seen_col, row - seen_row)
    # An outline's middle is not the image of the center, but here it is near.
    assert distance < 0.05, (col, row, seen_col, seen_row)


def main() -> None:
    folder = Path(sys.argv[1])
    count = 0
    for scene in SCENES:
        for name in [scene, f"{scene}-alpha"]:
            light = truth(folder, name)
            is_grey = np.array_equal(light[..., 0], light[..., 2])
            assert is_grey == (scene == "grey")
            assert light.max() > 1.2, "some pixels should be clipped"
            count += 1 + check_npz(folder, name, light)
            count += check_png(folder, name, light) + check_exr(folder, name, light)
            count += check_layers(folder, name, light)
    print(f"the same numbers: {count} of {count}")


main()
