"""Odometry of Fovea, KISS-ICP and small_gicp with one interface: frame in, T_world_lidar out.

Each works as its own documentation shows, with its own defaults.
"""
import dataclasses
import pathlib
from typing import Callable, Protocol

import fovea
import numpy as np
import numpy.typing as npt
import small_gicp
from kiss_icp.config import load_config
from kiss_icp.kiss_icp import KissICP

THREADS = 2

Pose = npt.NDArray[np.float64]


class Scan:
    """A frame with what the peers need, prepared before their time is measured."""

    def __init__(self, frame: fovea.Frame) -> None:
        self.frame = frame
        self.points = np.ascontiguousarray(frame.points, np.float64)
        self.times = sweep_times(frame)


def sweep_times(frame: fovea.Frame) -> npt.NDArray[np.float64]:
    """0 to 1 within the sweep. Without times of points they follow from the azimuth, as in KISS-ICP's loader."""
    if frame.time is not None:
        times = np.asarray(frame.time, np.float64)
        return (times - times.min()) / max(float(np.ptp(times)), 1e-9)
    azimuth = -np.arctan2(frame.points[:, 1], frame.points[:, 0]).astype(np.float64)
    return 0.5 * (azimuth / np.pi + 1)


@dataclasses.dataclass
class Tracked:
    T_world_lidar: Pose
    milliseconds: float | None = None  # None: all of track()


class Odometry(Protocol):
    drive: fovea.Drive  # the frames to track

    def track(self, scan: Scan) -> Tracked: ...


class FoveaOdometry:
    """Tracking without navigation and images: deskewing, registration to keyframes, their update, loop closure.

    The mapper always makes a map, too. Its time does not count here.
    """

    def __init__(self, path: pathlib.Path) -> None:
        self.drive = fovea.Drive(path, use_navigation=False, use_images=False)
        self.mapper = fovea.Mapper(self.drive)

    def track(self, scan: Scan) -> Tracked:
        record = self.mapper.process(scan.frame)
        return Tracked(record.T_local_lidar, record.milliseconds["register"])


class FoveaMapping:
    """The default: navigation, dense surfaces, colors of one camera, removal of what moves, the map."""

    def __init__(self, path: pathlib.Path) -> None:
        self.drive = fovea.Drive(path)
        self.mapper = fovea.Mapper(self.drive)

    def track(self, scan: Scan) -> Tracked:
        return Tracked(self.mapper.process(scan.frame).T_local_lidar)


class KissOdometry:
    """KISS-ICP's pipeline with deskewing."""

    def __init__(self, path: pathlib.Path) -> None:
        self.drive = fovea.Drive(path, use_images=False)
        config = load_config(None)
        config.registration.max_num_threads = THREADS
        self.odometry = KissICP(config)

    def track(self, scan: Scan) -> Tracked:
        self.odometry.register_frame(scan.points, scan.times)
        return Tracked(self.odometry.last_pose)


class SmallGicpOdometry:
    """small_gicp to a Gaussian voxel map with constant velocity, as in its KITTI example. It does not deskew."""

    VOXEL = 1.0  # m
    SAMPLING = 0.25  # m

    def __init__(self, path: pathlib.Path) -> None:
        self.drive = fovea.Drive(path, use_images=False)
        self.target = small_gicp.GaussianVoxelMap(self.VOXEL)
        self.target.set_lru(horizon=100, clear_cycle=10)
        self.T_world_lidar = self.T_last_current = np.eye(4)

    def track(self, scan: Scan) -> Tracked:
        cloud, _ = small_gicp.preprocess_points(scan.points, self.SAMPLING, num_threads=THREADS)
        if self.target.size() == 0:
            self.target.insert(cloud)
            return Tracked(self.T_world_lidar)
        guess = self.T_world_lidar @ self.T_last_current
        T_world_lidar = small_gicp.align(self.target, cloud, guess, num_threads=THREADS).T_target_source
        self.T_last_current = np.linalg.inv(self.T_world_lidar) @ T_world_lidar
        self.T_world_lidar = T_world_lidar
        self.target.insert(cloud, T_world_lidar)
        return Tracked(T_world_lidar)


METHODS: dict[str, Callable[[pathlib.Path], Odometry]] = {
    "Fovea, odometry": FoveaOdometry,
    "KISS-ICP": KissOdometry,
    "small_gicp, voxel map": SmallGicpOdometry,
    "Fovea, default map": FoveaMapping,
}
