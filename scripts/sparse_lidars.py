#!/usr/bin/env python3
"""Maps of a KITTI raw drive with fewer rings, and of a simulated open square: docs/accuracy.md.

usage: sparse_lidars.py FOVEA DRIVE [KEY=VALUE...]

Prints a table. Pose errors of DRIVE are distances to the poses of the map of all rings, aligned by
one rigid motion; scores are those of `fovea evaluate` on all rings. The keys are settings of the
maps with fewer rings."""
import json
import os
import subprocess
import sys
import tempfile

import numpy as np

from dropped_rings import copy_with_rings, every, nearest_to

DRIVES = {
    "64 rings": every(1, 0),
    "32 rings": every(2, 1),
    "16 rings": every(4, 1),
    "10 rings, 2 degrees apart": nearest_to(np.arange(1, -18, -2)),
    "8 rings": every(8, 1),
}
SMALL_IMAGES = ["camera.width=320", "camera.height=96", "camera.focal=185", "camera.cx=159.5",
                "camera.cy=44", "camera.numbers=[2]"]


def run(*command):
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout


def read_poses(path):
    rows = np.loadtxt(path).reshape(-1, 3, 4)
    return rows[:, :, :3], rows[:, :, 3]


def distances(truth, poses):
    """Position errors in cm, after the alignment that fits rotations and mean position best."""
    (rotations, places), (other_rotations, other_places) = truth, poses
    u, _, v = np.linalg.svd(np.einsum("nij,nkj->ik", rotations, other_rotations))
    turn = u @ np.diag([1, 1, np.linalg.det(u @ v)]) @ v
    moved = other_places @ turn.T
    return 100 * np.linalg.norm(places - places.mean(0) - moved + moved.mean(0), axis=1)


def settings(keys):
    return [argument for key in keys for argument in ("--set", key)]


def map_and_export(fovea, drive, scratch, keys):
    run(fovea, "map", drive, "-o", scratch + "/map.fovea", "--force", "--quiet", "--hold-out", "8:4",
        *settings(keys))
    if os.path.exists(scratch + "/poses.txt"):
        os.remove(scratch + "/poses.txt")
    run(fovea, "export", scratch + "/map.fovea", scratch + "/poses.txt", "--format", "kitti-poses")
    return read_poses(scratch + "/poses.txt")


def scores(fovea, drive, scratch):
    run(fovea, "evaluate", scratch + "/map.fovea", drive, "--json", scratch + "/scores.json")
    report = json.load(open(scratch + "/scores.json"))
    return report["te_mean"], report["coverage_5cm"]


def print_row(name, navigation, errors, te=None, coverage=None):
    te = "" if te is None else f"{te:.1f}"
    coverage = "" if coverage is None else f"{coverage:.3f}"
    rms = np.sqrt(np.mean(errors**2))
    print(f"| {name} | {navigation} | {errors.mean():.2f} | {rms:.2f} | {errors.max():.2f} | {te} "
          f"| {coverage} |", flush=True)


def kitti_rows(fovea, drive, scratch, keys):
    reference = map_and_export(fovea, drive, scratch, [])
    for name, choose in DRIVES.items():
        for navigation, but in (("yes", []), ("no", ["oxts"])):
            with tempfile.TemporaryDirectory() as root:
                copy = copy_with_rings(drive, root, choose, but)
                errors = distances(reference, map_and_export(fovea, copy, scratch, keys))
                print_row(name, navigation, errors,
                          *(scores(fovea, drive, scratch) if navigation == "yes" else ()))


def square_rows(fovea, scratch, keys):
    square = scratch + "/square"
    run(fovea, "simulate", "-o", square, "--format", "generic", "--scene", "plaza", "--seed", "3",
        "--frames", "40", "--quiet", *settings(["lidar.model=vlp16", *SMALL_IMAGES]))
    truth = read_poses(square + "/truth/poses.txt")
    for navigation in ("yes", "no"):
        if navigation == "no":
            os.remove(square + "/gnss.csv")
        print_row("open square, VLP-16 (simulated)", navigation,
                  distances(truth, map_and_export(fovea, square, scratch, keys)))


def main():
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    fovea, drive, *keys = sys.argv[1:]
    print("| drive | navigation | pose error, cm: mean | RMS | max | TE | coverage 5 cm |")
    print("| --- | --- | --- | --- | --- | --- | --- |")
    with tempfile.TemporaryDirectory() as scratch:
        kitti_rows(fovea, drive, scratch, keys)
        square_rows(fovea, scratch, keys)


if __name__ == "__main__":
    main()
