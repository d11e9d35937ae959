"""Whether the readers of others find in every kind of file the numbers that marbles computed.

Usage: formats.py FOLDER, with the pictures of `crates/cli/tests/process/readers.rs` in FOLDER, and
numpy, Pillow, imageio, OpenCV and OpenEXR on the path. OpenImageIO, pyexr, Mitsuba and Blender (`bpy`) are tried if they
are on the path, too.

The array of doubles is the truth: each other file has to hold it, rounded once to the file's own numbers.
"""

import importlib.util
import os
import subprocess
import sys
from pathlib import Path

os.environ["OPENCV_IO_ENABLE_OPENEXR"] = "1"  # read when cv2 is imported

import cv2
import imageio.v3 as iio
import numpy as np
import OpenEXR
from PIL import Image

SCENES = ["color", "grey"]
NAMES = [f"{scene}{alpha}" for scene in SCENES for alpha in ["", "-alpha"]]
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
        assert sorted(found) == sorted([*names, "error.V"]), sorted(found)
        for index, channel in enumerate(names):
            assert found[channel].dtype == number, (path, channel)
            assert np.array_equal(found[channel], expected[..., index]), (path, channel)
        assert found["error.V"].dtype == np.float32
        assert is_rounded_up(found["error.V"], error)
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


def is_rounded_up(stored: np.ndarray, error: np.ndarray) -> bool:
    """Whether these are the smallest floats that are not below the errors."""
    return (stored >= error).all() and (np.nextafter(stored, np.float32(-1)) < error).all()


def check_sum(folder: Path, name: str, light: np.ndarray) -> int:
    """The picture is where it is without layers, and they make it as far as errors and the rounding of floats allow."""
    path = folder / f"{name}.layers.exr"
    expected = light.astype(np.float32)
    with OpenEXR.File(str(path), separate_channels=True) as file:
        found = {channel: data.pixels.astype(float) for channel, data in file.channels().items()}
    layers = ["light-1", "ambient"]
    names = [*"RGBA"[: light.shape[2]], "error.V", *[f"{layer}_error.V" for layer in layers]]
    names += [f"{layer}.{channel}" for layer in layers for channel in "RGB"]
    assert sorted(found) == sorted(names), sorted(found)
    error = found["error.V"] + sum(found[f"{layer}_error.V"] for layer in layers) + SLACK
    for index, channel in enumerate("RGB"):
        assert np.array_equal(found[channel], expected[..., index]), (path, channel)
        summed = sum(found[f"{layer}.{channel}"] for layer in layers)
        assert (np.abs(summed - found[channel]) <= error).all(), (path, channel)
    assert found["light-1.R"].max() > 1, path
    full = cv2.imread(str(path), cv2.IMREAD_UNCHANGED)
    assert full is not None and np.array_equal(rgb(full), expected), path
    return 1


def true_layers(folder: Path, name: str) -> dict[str, np.ndarray]:
    """The arrays of NPZ files, under the names of the layers of `NAME.all.exr`. The name of the picture is empty."""
    layers = {}
    for key, suffix in [("", ""), ("light-1", ".light-1"), ("ambient", ".ambient")]:
        with np.load(folder / f"{name}.all{suffix}.npz") as file:
            arrays = dict(file)
        light = arrays.pop("light")
        layers[key] = light[..., :3] if key else light
        layers[f"{key}_error" if key else "error"] = arrays.pop("error")
        layers |= arrays if not key else {}
    assert len(layers) == 6 + 11, sorted(layers)
    return layers


def check_true(found: dict[str, np.ndarray], layers: dict[str, np.ndarray], reader: str, exact_ids: bool) -> int:
    """Fails where a reader finds other layers than those of the NPZ files, or other numbers."""
    assert sorted(found) == sorted(layers), (reader, sorted(found), sorted(layers))
    for name, exact in layers.items():
        stored = found[name]
        assert stored.shape == exact.shape, (reader, name, stored.shape, exact.shape)
        if exact.dtype == np.uint32:
            number = np.uint32 if exact_ids else np.float32
            assert stored.dtype == number and np.array_equal(stored, exact.astype(number)), (reader, name)
        elif name in ["error", "light-1_error", "ambient_error"]:
            assert stored.dtype == np.float32 and is_rounded_up(stored, exact), (reader, name)
        else:
            # Light is rounded once. Channels are computed for each type of numbers, to the last places.
            some = np.isfinite(exact)
            assert stored.dtype == np.float32 and np.array_equal(stored[~some], exact[~some]), (reader, name)
            slack = np.spacing(np.abs(stored[some])) * (0.5 if name in ["", "light-1", "ambient"] else 2)
            assert (np.abs(stored[some] - exact[some]) <= slack).all(), (reader, name)
    return 1


def grouped(channels: dict[str, np.ndarray]) -> dict[str, np.ndarray]:
    """The layers of channels; those of several components have them along their last axis."""
    layers: dict[str, dict[str, np.ndarray]] = {}
    for channel, numbers in channels.items():
        layer, _, component = channel.rpartition(".")
        layers.setdefault(layer, {})[component] = numbers
    for layer, components in layers.items():
        order = "V" if "V" in components else "Z" if len(components) == 1 else "XYZ" if "X" in components else "RGBA"
        assert set(components) <= set(order), (layer, list(components))
        arrays = [components[component] for component in order if component in components]
        layers[layer] = arrays[0] if len(arrays) == 1 else np.stack(arrays, axis=-1)
    return layers


def by_openexr(path: Path) -> dict[str, np.ndarray]:
    with OpenEXR.File(str(path), separate_channels=True) as file:
        channels = {name: channel.pixels.copy() for part in file.parts for name, channel in part.channels.items()}
    return grouped(channels)


def by_openimageio(path: Path) -> dict[str, np.ndarray]:
    """Each channel in its own type. As floats, indices of spheres would be divided by 2^32 - 1."""
    import OpenImageIO

    file = OpenImageIO.ImageInput.open(str(path))
    spec = file.spec()
    assert spec.alpha_channel == (3 if "A" in spec.channelnames else -1), spec.alpha_channel
    channels = {
        name: file.read_image(0, 0, index, index + 1, spec.channelformat(index))[..., 0]
        for index, name in enumerate(spec.channelnames)
    }
    file.close()
    return grouped(channels)


def by_pyexr(path: Path) -> dict[str, np.ndarray]:
    """The groups of pyexr, by their names."""
    import pyexr

    with pyexr.open(str(path)) as file:
        layers = {"" if name == "default" else name: file.get(name) for name in file.root_channels}
        for name in ["id", "coverage_id"]:
            layers[name] = file.get(name, pyexr.UINT)
    return {name: array if array.shape[2] > 1 else array[..., 0] for name, array in layers.items()}


def by_mitsuba(path: Path) -> dict[str, np.ndarray]:
    """The bitmaps of Mitsuba, which have floats alone."""
    import mitsuba

    mitsuba.set_variant("scalar_rgb")
    bitmaps = {"" if name == "<root>" else name: bitmap for name, bitmap in mitsuba.Bitmap(str(path)).split()}
    formats = mitsuba.Bitmap.PixelFormat
    for name in ["", "light-1", "ambient", "albedo"]:
        assert bitmaps[name].pixel_format() in [formats.RGB, formats.RGBA], (name, bitmaps[name])
    for name in ["normal", "position", "mean_normal"]:
        assert bitmaps[name].pixel_format() == formats.XYZ, (name, bitmaps[name])
    return {name: np.array(bitmap) for name, bitmap in bitmaps.items()}


def by_blender(path: Path) -> dict[str, np.ndarray]:
    """The passes of Blender's compositor, which have floats alone; vectors of older versions have four of them."""
    written = path.with_suffix(".blender.exr")
    script = Path(__file__).with_name("through_blender.py")
    subprocess.run([sys.executable, script, path, written], check=True, stdout=subprocess.DEVNULL)
    layers = by_openexr(written)
    has_alpha = "A" in OpenEXR.File(str(path), separate_channels=True).channels()
    layers[""] = layers.pop("Combined")[..., : 4 if has_alpha else 3]
    layers.pop("Alpha", None)
    colors = [name for name, array in layers.items() if name and array.ndim == 3]
    return layers | {name: layers[name][..., :3] for name in colors}


# The readers of layers: the module, and whether integers stay integers.
READERS = {
    "OpenEXR": ("OpenEXR", by_openexr, True),
    "OpenImageIO": ("OpenImageIO", by_openimageio, True),
    "pyexr": ("pyexr", by_pyexr, True),
    "Mitsuba": ("mitsuba", by_mitsuba, False),
    "Blender": ("bpy", by_blender, False),
}


def check_layers(folder: Path) -> None:
    """Every reader finds all channels, each layer under its name, and nothing in the picture that is not of it."""
    for reader, (module, read, exact_ids) in READERS.items():
        if importlib.util.find_spec(module) is None:
            print(f"skipped: {reader} is not installed")
            continue
        count = 0
        for name in NAMES:
            layers = true_layers(folder, name)
            count += check_true(read(folder / f"{name}.all.exr"), layers, reader, exact_ids)
        print(f"layers of an EXR by {reader}: {count} of {len(NAMES)}")
    for name in NAMES:
        # OpenCV reads the picture alone.
        full = cv2.imread(str(folder / f"{name}.all.exr"), cv2.IMREAD_UNCHANGED)
        assert full is not None and np.array_equal(rgb(full), truth(folder, name).astype(np.float32)), name


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
    for name in NAMES:
        light = truth(folder, name)
        is_grey = np.array_equal(light[..., 0], light[..., 2])
        assert is_grey == name.startswith("grey")
        assert light.max() > 1.2, "some pixels should be clipped"
        count += 1 + check_npz(folder, name, light)
        count += check_png(folder, name, light) + check_exr(folder, name, light)
        count += check_sum(folder, name, light)
    check_layers(folder)
    print(f"the same numbers: {count} of {count}")


main()
