#!/usr/bin/env python3
"""All colored points of a Fovea map as text, `x y z red green blue` a line, m in the local frame.

Reads the file as docs/map-format.md describes it: with SQLite and zstd, and without Fovea.
Usage: read_map.py MAP.fovea > POINTS.txt
"""
import itertools
import sqlite3
import sys

import zstandard


def unpack(blob):
    return zstandard.ZstdDecompressor().decompress(blob)


def plane(data, n, k):
    """The n numbers of the k-th plane of differences in `data`."""
    low, high = data[2 * n * k:][:n], data[2 * n * k + n:][:n]
    coded = (a + 256 * b for a, b in zip(low, high))
    differences = (d // 2 if d % 2 == 0 else -(d + 1) // 2 for d in coded)
    return [number % 65536 for number in itertools.accumulate(differences)]


def byte_runs(data):
    """The values of runs of single bytes."""
    values, lengths = data[:len(data) // 2], data[len(data) // 2:]
    return [value for value, length in zip(values, lengths) for _ in range(length + 1)]


def byte_of(code):
    """The 8-bit value of a color code."""
    return 0 if code == 0 else min(255, round(2 ** ((code - 1024) / 256)))


database = sqlite3.connect(f"file:{sys.argv[1]}?mode=ro", uri=True)
if database.execute("PRAGMA user_version").fetchone() != (7,):
    sys.exit("read_map: not a Fovea map of format version 7")
pose = {number: [float(word) for word in text.split()]
        for number, text in database.execute("SELECT id, pose FROM submaps")}
for submap, n, ox, oy, oz, position, color, camera in database.execute(
        "SELECT submap, points, origin_x_m, origin_y_m, origin_z_m, position_mm, color, camera"
        " FROM tiles ORDER BY submap, x, y, z"):
    T, position, color = pose[submap], unpack(position), unpack(color)
    camera = byte_runs(unpack(camera))
    axes = [[o + mm / 1000 for mm in plane(position, n, k)] for k, o in enumerate((ox, oy, oz))]
    green, red_green, blue_green = (plane(color, n, k) for k in range(3))
    for i, (x, y, z) in enumerate(zip(*axes)):
        if camera[i] == 255:  # -1: no camera saw it
            continue
        p = (T[r] * x + T[r + 1] * y + T[r + 2] * z + T[r + 3] for r in (0, 4, 8))
        codes = ((green[i] + d) % 65536 for d in (red_green[i], 0, blue_green[i]))
        print(*(f"{value:.4f}" for value in p), *(byte_of(code) for code in codes))
