"""Projects the centers of spheres with OpenCV, by the K, R and t of a sidecar, and looks for them in the picture.

Usage: project_points.py SIDECAR PICTURE SPHERES

PICTURE is a 16 bit PNG of white spheres without shading on black, so that a pixel is the part of it that spheres
cover. SPHERES is a table of center and radius, `x,y,z,radius`, in the axes of the scene file.
"""

import json
import sys

import cv2
import numpy as np

# In pixels. A pixel on an outline counts at its center, which moves the centroid of a disc with a radius of 20 pixels
# by a few 1e-4.
TOLERANCE = 1e-3

sidecar_path, picture_path, spheres_path = sys.argv[1:]
with open(sidecar_path, encoding="utf-8") as file:
    sidecar = json.load(file)
camera = sidecar["camera"]
assert camera["kind"] == "pinhole" and camera["axes"] == "opencv"
K, R, t, position = (np.array(camera[name]) for name in ("K", "R", "t", "position"))
assert np.allclose(R @ R.T, np.eye(3), rtol=0, atol=1e-14) and np.linalg.det(R) > 0
assert np.allclose(R @ position + t, 0, rtol=0, atol=1e-12)

spheres = np.loadtxt(spheres_path, delimiter=",", skiprows=1)
# The sidecar's world is right-handed: that of the scene with z negated.
centers, radii = spheres[:, :3] * [1, 1, -1], spheres[:, 3]
projected, _ = cv2.projectPoints(centers, cv2.Rodrigues(R)[0], t, K, None)
projected = projected.reshape(-1, 2)

codes = cv2.imread(picture_path, cv2.IMREAD_UNCHANGED)
assert codes.dtype == np.uint16 and codes.ndim == 2
assert codes.shape == (sidecar["image"]["height"], sidecar["image"]["width"])
encoded = codes / 65535.0
covered = np.where(encoded <= 0.04045, encoded / 12.92, ((encoded + 0.055) / 1.055) ** 2.4)

worst = 0.0
for center, radius, pixel in zip(centers, radii, projected):
    z = (R @ center + t)[2]
    # The middle of an outline is farther from the principal point than the projection of the sphere's center.
    expected = K[:2, 2] + (pixel - K[:2, 2]) * z**2 / (z**2 - radius**2)
    reach = 1.5 * K[0, 0] * radius / z + 3
    (left, top), (right, bottom) = np.floor(expected - reach).astype(int), np.ceil(expected + reach).astype(int)
    assert left >= 0 and top >= 0 and right < codes.shape[1] and bottom < codes.shape[0], "outside of the picture"
    window = covered[top : bottom + 1, left : right + 1]
    assert window.sum() > 1, f"there is no sphere at {expected}"
    rows, cols = np.mgrid[top : bottom + 1, left : right + 1]
    found = np.array([(window * cols).sum(), (window * rows).sum()]) / window.sum()
    worst = max(worst, np.abs(found - expected).max())
print(f"{len(spheres)} spheres, the farthest {worst:.1e} pixels from where OpenCV projects it")
assert worst <= TOLERANCE
