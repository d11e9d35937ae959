"""Recovers normals by least squares from a data set, and prints how far they are from the true ones.

Usage: photometric_stereo.py FOLDER, where FOLDER has the files of `marbles dataset --layout diligent`.
Needs numpy, scipy and OpenCV. Exits with 1 if any normal is off by more than a thousandth of a degree.
"""

import sys
from pathlib import Path

import cv2
import numpy as np
import scipy.io

DARK = 0.02  # brighter than any pixel that is only partly lit

folder = Path(sys.argv[1])
directions = np.loadtxt(folder / "light_directions.txt")
intensities = np.loadtxt(folder / "light_intensities.txt")
names = (folder / "filenames.txt").read_text().split()
measured = []  # the albedo, averaged over the colors, times n·l
for name, intensity in zip(names, intensities, strict=True):
    picture = cv2.imread(str(folder / name), cv2.IMREAD_UNCHANGED)[..., ::-1]
    measured.append((picture / 65535 / intensity).mean(axis=-1))
measured = np.stack(measured)

mask = cv2.imread(str(folder / "mask.png"), cv2.IMREAD_GRAYSCALE) > 0
lit = mask & (measured.min(axis=0) > DARK)  # all lights reach these pixels
found, *_ = np.linalg.lstsq(directions, measured[:, lit], rcond=None)
found = (found / np.linalg.norm(found, axis=0)).T

truth = scipy.io.loadmat(folder / "Normal_gt.mat")["Normal_gt"][lit]
angle = np.degrees(2 * np.arcsin(np.linalg.norm(found - truth, axis=1) / 2))
print(f"{len(angle)} of {mask.sum()} pixels see all {len(names)} lights")
print(f"angular error: mean {angle.mean():.1e}, largest {angle.max():.1e} degrees")
sys.exit(int(angle.max() > 1e-3))
