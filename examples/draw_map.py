"""Draws a map from above, 10 cm a pixel: draw_map.py MAP.fovea PICTURE.ppm"""
import sys

import fovea
import numpy as np

PIXEL = 0.1  # m

with fovea.Map(sys.argv[1]) as street:
    points = street.points(where="camera >= 0")

xyz = points.xyz
left, bottom = np.floor(xyz[:, :2].min(axis=0) / PIXEL).astype(int)
right, top = np.floor(xyz[:, :2].max(axis=0) / PIXEL).astype(int)
column = np.floor(xyz[:, 0] / PIXEL).astype(int) - left
row = top - np.floor(xyz[:, 1] / PIXEL).astype(int)

picture = np.zeros((top - bottom + 1, right - left + 1, 3), np.uint8)
upward = np.argsort(xyz[:, 2])  # the last point of a pixel stays: the highest
picture[row[upward], column[upward]] = points.color[upward]

with open(sys.argv[2], "wb") as file:
    file.write(b"P6 %d %d 255\n" % (picture.shape[1], picture.shape[0]))
    file.write(picture.tobytes())
print(f"{len(points)} points on {picture.shape[1]} x {picture.shape[0]} pixels")
