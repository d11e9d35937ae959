"""Predicts the pictures of a data set from its lights, normals and depths, and prints how far they are from the true ones.

Usage: near_lights.py FOLDER, where FOLDER has the files of `marbles dataset scenes/near_lights.ron --layout luces`.
Needs numpy and OpenCV. Exits with 1 if a predicted pixel is off by more than 1e-4, or if fewer than half are predicted.
"""

import sys
from pathlib import Path

import cv2
import numpy as np

ALBEDOS = [(0.75, 0.45, 0.3), (0.9, 0.9, 0.9), (0.35, 0.4, 0.5)]  # of the balls, from left to right

folder = Path(sys.argv[1])
setup = (folder / "led_params.txt").read_text().rstrip().split("\n")
count, height, width, f, x0, y0, mean_distance = map(float, setup[1].split(" "))
lights = np.array([line.split(" ") for line in setup[2:]], float)

mask = cv2.imread(str(folder / "mask.png"), cv2.IMREAD_GRAYSCALE)
normal = cv2.imread(str(folder / "normals.png"), cv2.IMREAD_UNCHANGED)[..., ::-1] / 32767.5 - 1
normal *= (1, -1, -1)  # y down and z forward, as in the positions of lights
normal /= np.linalg.norm(normal, axis=-1, keepdims=True)
depth = np.load(folder / "zgt.npz")["zgt"]
rows, cols = np.indices(depth.shape)
point = np.stack([(cols - x0) / f, (rows - y0) / f, np.ones_like(depth)], axis=-1) * depth[..., None]

_, labels, _, middles = cv2.connectedComponentsWithStats(mask)
albedo = np.zeros((*mask.shape, 3))
for label, color in zip(1 + np.argsort(middles[1:, 0]), ALBEDOS, strict=True):
    albedo[labels == label] = color

inside = cv2.erode(mask, np.ones((5, 5))) > 0
worst, pixels = 0.0, 0
for index, (light, intensity) in enumerate(zip(lights[:, :3], lights[:, 6:9])):
    way = light - point
    distance = np.linalg.norm(way, axis=-1)
    cosine = np.einsum("...i,...i", normal, way) / distance
    shading = np.maximum(cosine, 0) * (mean_distance / distance) ** 2
    shading += cv2.Laplacian(shading, cv2.CV_64F, ksize=1) / 24  # the average over the pixel
    picture = cv2.imread(str(folder / f"{index + 1:02}.png"), cv2.IMREAD_UNCHANGED)[..., ::-1] / 65535
    predicted = albedo * intensity * shading[..., None]
    reached = (cosine > 0.1) & (picture[..., 0] > 0.5 * predicted[..., 0])  # not in a shadow
    lit = inside & (cv2.erode(reached.astype(np.uint8), np.ones((5, 5))) > 0)
    worst, pixels = max(worst, np.abs(predicted - picture)[lit].max()), pixels + lit.sum()

print(f"{pixels} of {int(count) * (mask > 0).sum()} pixels are predicted, the worst within {worst:.1e}")
sys.exit(int(worst > 1e-4 or pixels < 0.5 * count * (mask > 0).sum()))
