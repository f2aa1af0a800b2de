#!/usr/bin/env python3
"""Plants errors in the calibration of a drive's camera and prints what `fovea calibrate` finds.

    scripts/planted_calibrations.py FOVEA DRIVE [COUNT]

Each error is 5 degrees about a random axis, 20 cm across the camera's view in a random direction, and 100 ms.
Prints rows of a table: the planted error, then the estimate less the planted error.
"""
import json
import subprocess
import sys
import tempfile
import tomllib
from pathlib import Path

import numpy as np


def rotation_of(vector):
    angle = np.linalg.norm(vector)
    if angle == 0:
        return np.eye(3)
    x, y, z = vector / angle
    K = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + np.sin(angle) * K + (1 - np.cos(angle)) * K @ K


def calibrate(fovea, drive, folder):
    """Runs fovea calibrate: T_cam_lidar and delay that it writes, and the values that it reports."""
    subprocess.run([fovea, "calibrate", drive, "-o", folder, "--json", folder / "values.json", "--force", "--quiet"],
                   check=True)
    camera = json.loads((folder / "values.json").read_text())["calibration"][0]
    written = tomllib.loads((folder / "drive.toml").read_text())["calibrated"]["camera"][str(camera["camera"])]
    T = np.vstack([np.array(written["T_cam_lidar"]), [0, 0, 0, 1]])
    return T, camera


def values(camera):
    """Rotation (degrees), translation (m), delay (ms); NaN for what is not observable."""
    def three(key):
        return [np.nan if v is None else v for v in camera[key] or [None] * 3]
    delay = camera["time_offset_ms"]
    return np.array(three("rotation_deg")), np.array(three("translation_m")), np.nan if delay is None else delay


def correction(camera):
    rotation, translation, _ = values(camera)
    T = np.eye(4)
    T[:3, :3] = rotation_of(np.radians(np.nan_to_num(rotation)))
    T[:3, 3] = T[:3, :3] @ np.nan_to_num(translation)
    return T


def main():
    fovea, drive = sys.argv[1], Path(sys.argv[2]).resolve()
    count = int(sys.argv[3]) if len(sys.argv) > 3 else 4
    random = np.random.default_rng(7)
    with tempfile.TemporaryDirectory() as scratch:
        folder = Path(scratch)
        (folder / "given").mkdir()
        T_found, camera = calibrate(fovea, drive, folder / "given")
        T_given = np.linalg.inv(correction(camera)) @ T_found
        print("| planted: degrees x y z, cm x y, ms | off by: degrees x y z | cm x y z | ms |\n| --- | --- | --- | --- |")
        for i in range(count + 1):
            rotation, translation, delay = np.zeros(3), np.zeros(3), 0.0
            if i > 0:
                rotation = random.normal(size=3)
                rotation *= 5 / np.linalg.norm(rotation)
                translation[:2] = random.normal(size=2)
                translation *= 0.2 / np.linalg.norm(translation)
                delay = float(random.choice([-100, 100]))
            planted = np.eye(4)
            planted[:3, :3] = rotation_of(np.radians(rotation))
            planted[:3, 3] = planted[:3, :3] @ translation
            wrong = folder / "wrong"
            wrong.mkdir(exist_ok=True)
            (wrong / "drive.toml").write_text(
                f'version = 1\n[calibrated]\ndrive = "{drive}"\n[calibrated.camera.{camera["camera"]}]\n'
                f"T_cam_lidar = {(np.linalg.inv(planted) @ T_given)[:3].tolist()}\nadded_delay = {-delay / 1e3}\n")
            _, found = calibrate(fovea, wrong, folder / "given")
            r, t, ms = values(found)
            def row(numbers, digits):
                return " ".join("-" if np.isnan(n) else f"{n:.{digits}f}" for n in numbers)
            print(f"| {row(rotation, 2)}, {row(100 * translation[:2], 1)}, {delay:.0f} "
                  f"| {row(r - rotation, 3)} | {row(100 * (t - translation), 1)} | {ms - delay:.1f} |", flush=True)


main()
