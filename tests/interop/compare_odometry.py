"""Timings and poses of Fovea, KISS-ICP and small_gicp on one drive, in one process, in turns:

    compare_odometry.py DRIVE [--runs 3]

Positions are compared with the truth of a simulated drive, or else with GPS/INS, after an alignment. The first scans,
in which each method finds the motion, do not count.
"""
import argparse
import dataclasses
import os
import pathlib
import sys
import time

import fovea
import numpy as np
from evo.core import metrics
from evo.core.trajectory import PosePath3D

from odometry_peers import METHODS, THREADS, Odometry, Pose, Scan

PIECE = 10.0  # m
BEGIN = 5  # scans that do not count


@dataclasses.dataclass
class Figures:
    """Of one run of one method."""

    ms_median: float
    ms_95: float
    aligned_rms_m: float
    drift_percent: float


def reference_poses(path: pathlib.Path) -> tuple[str, list[Pose]]:
    """T_world_lidar of each frame, and where they are from."""
    for truth in sorted(path.glob("truth/poses.txt")):
        lines = np.loadtxt(truth).reshape(-1, 3, 4)
        return "truth", [np.vstack([pose, [0, 0, 0, 1]]) for pose in lines]
    drive = fovea.Drive(path, use_images=False)
    mapper = fovea.Mapper(drive)
    records = [mapper.process(frame, held_out=True) for frame in drive]
    poses = [record.T_local_lidar_navigation for record in records]
    if any(pose is None for pose in poses):
        raise fovea.InputError("there is neither truth nor GPS/INS for all frames", str(path), "use another drive")
    return "GPS/INS", [pose for pose in poses if pose is not None]


def run(odometry: Odometry) -> tuple[list[Pose], list[float]]:
    """The pose and the milliseconds of each scan."""
    poses, milliseconds = [], []
    for frame in odometry.drive:
        scan = Scan(frame)
        begin = time.perf_counter()
        tracked = odometry.track(scan)
        elapsed = 1000 * (time.perf_counter() - begin)
        milliseconds.append(elapsed if tracked.milliseconds is None else tracked.milliseconds)
        poses.append(np.array(tracked.T_world_lidar))
    return poses, milliseconds


def score(poses: list[Pose], milliseconds: list[float], reference: list[Pose]) -> Figures:
    truth, estimate = (PosePath3D(poses_se3=each[BEGIN:]) for each in (reference, poses))
    drift = metrics.RPE(metrics.PoseRelation.translation_part, PIECE, metrics.Unit.meters, all_pairs=True)
    drift.process_data((truth, estimate))
    estimate.align(truth)
    absolute = metrics.APE(metrics.PoseRelation.translation_part)
    absolute.process_data((truth, estimate))
    return Figures(float(np.median(milliseconds[BEGIN:])), float(np.percentile(milliseconds[BEGIN:], 95)),
                   absolute.get_statistic(metrics.StatisticsType.rmse),
                   100 / PIECE * drift.get_statistic(metrics.StatisticsType.mean))


def compare(path: pathlib.Path, runs: int) -> tuple[str, dict[str, Figures]]:
    """The source of the reference, and by method the medians of the runs."""
    os.sched_setaffinity(0, sorted(os.sched_getaffinity(0))[:THREADS])  # Fovea takes as many threads as processors
    source, reference = reference_poses(path)
    figures: dict[str, list[Figures]] = {name: [] for name in METHODS}
    for _ in range(runs):
        for name, method in METHODS.items():
            figures[name].append(score(*run(method(path)), reference))
    return source, {name: Figures(*np.median([dataclasses.astuple(one) for one in all_runs], axis=0))
                    for name, all_runs in figures.items()}


def print_table(path: pathlib.Path, runs: int, source: str, figures: dict[str, Figures]) -> None:
    print(f"{path.name}: {THREADS} threads, medians of {runs} runs in turns, against {source}")
    print("| method | ms a scan, median | 95th percentile | aligned positions, RMS, cm | drift over 10 m, % |")
    print("| --- | --- | --- | --- | --- |")
    for name, one in figures.items():
        print(f"| {name} | {one.ms_median:.1f} | {one.ms_95:.1f} | {100 * one.aligned_rms_m:.1f} "
              f"| {one.drift_percent:.2f} |")


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("drive", type=pathlib.Path)
    parser.add_argument("--runs", type=int, default=3)
    arguments = parser.parse_args()
    print_table(arguments.drive, arguments.runs, *compare(arguments.drive, arguments.runs))
    return 0


if __name__ == "__main__":
    sys.exit(main())
