#!/usr/bin/env python3
"""What `fovea map` says about cameras turned on purpose: the table of docs/calibration.md.

usage: calibration_outcomes.py FOVEA DRIVE

DRIVE is a KITTI raw drive. Each column has some of its rings, each row a camera turned about one of
its axes. Cells: "ok", "N px" (a warning with --calibrate), "disagree" (a warning) or "-" (not
observable, no warning)."""
import json
import os
import re
import subprocess
import sys
import tempfile

import numpy as np

from dropped_rings import copy_with_rings, every

RINGS = {64: (1, 0), 32: (2, 0), 16: (4, 1), 8: (8, 0)}
DEGREES = [0.5, 1, 2, 5, 10]


def turn(calibration, axis, degrees):
    """calib_velo_to_cam.txt with the camera turned about its axis 0, 1 or 2."""
    rows = dict(line.split(":", 1) for line in calibration.splitlines() if ":" in line)
    c, s = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    i, j = (axis + 1) % 3, (axis + 2) % 3
    turned = np.eye(3)
    turned[i, i], turned[i, j], turned[j, i], turned[j, j] = c, -s, s, c
    for key, shape in (("R", (3, 3)), ("T", (3, 1))):
        values = turned @ np.array(rows[key].split(), float).reshape(shape)
        line = f"{key}: " + " ".join(repr(float(v)) for v in values.ravel())
        calibration = re.sub(rf"(?m)^{key}:.*$", line, calibration)
    return calibration


def outcome(fovea, drive, scratch):
    report = scratch + "/report.json"
    subprocess.run([fovea, "map", drive, "-o", scratch + "/map.fovea", "--force", "--quiet",
                    "--report", report], check=True, stdout=subprocess.DEVNULL)
    camera = json.load(open(report))["map"]["calibration"][0]
    if camera["disagrees"]:
        return "disagree"
    if camera["pixels"] is None:
        return "-"
    return f"{camera['pixels']:.0f} px" if camera["off_by_a_pixel"] else "ok"


def outcomes(fovea, drive, divisor, rest, turns):
    """One cell a turn, for a copy of the drive with some of its rings."""
    given = open(os.path.dirname(drive) + "/calib_velo_to_cam.txt").read()
    cells = []
    with tempfile.TemporaryDirectory() as root:
        copy = copy_with_rings(drive, root + "/drive", every(divisor, rest))
        file = os.path.dirname(copy) + "/calib_velo_to_cam.txt"
        os.remove(file)
        for axis, degrees in turns:
            with open(file, "w") as stream:
                stream.write(turn(given, axis, degrees))
            cells.append(outcome(fovea, copy, root))
    return cells


def main():
    fovea, drive = os.path.realpath(sys.argv[1]), os.path.realpath(sys.argv[2])
    turns = [(0, 0)] + [(axis, degrees) for degrees in DEGREES for axis in range(3)]
    columns = [outcomes(fovea, drive, *rings, turns) for rings in RINGS.values()]
    print("| turned by | " + " | ".join(f"{rings} rings" for rings in RINGS) + " |")
    print("| --- " * (1 + len(RINGS)) + "|")
    for (axis, degrees), *cells in zip(turns, *columns):
        name = f"{degrees:g} about {'xyz'[axis]}" if degrees else "nothing"
        print(f"| {name} | " + " | ".join(cells) + " |")


if __name__ == "__main__":
    main()
