"""Copies of a KITTI raw drive in which the LiDAR has fewer rings."""
import os

import numpy as np


def ring_numbers(points):
    """The ring of each point. Each ring begins ahead and turns to the left."""
    azimuth = np.arctan2(points[:, 1], points[:, 0]) % (2 * np.pi)
    return np.concatenate([[0], np.cumsum(np.diff(azimuth) < -np.pi)])


def every(divisor, rest):
    """Chooses every so many-th ring."""
    return lambda points, ring: ring % divisor == rest


def nearest_to(elevations_deg):
    """Chooses the rings whose elevations are nearest to the given ones."""

    def choose(points, ring):
        elevation = np.degrees(np.arctan2(points[:, 2], np.hypot(points[:, 0], points[:, 1])))
        median = np.array([np.median(elevation[ring == r]) for r in range(ring.max() + 1)])
        return np.isin(ring, [np.argmin(np.abs(median - e)) for e in elevations_deg])

    return choose


def link_all(source, target, but):
    os.makedirs(target)
    for name in os.listdir(source):
        if name not in but:
            os.symlink(os.path.join(os.path.realpath(source), name), os.path.join(target, name))


def copy_with_rings(drive, root, choose, but=()):
    """A copy of the drive under `root`, without the entries `but`; all else is links.
    choose(points, ring) is the mask of the points that stay."""
    drive = os.path.realpath(drive)
    date = os.path.join(root, os.path.basename(os.path.dirname(drive)))
    copy = os.path.join(date, os.path.basename(drive))
    link_all(os.path.dirname(drive), date, [os.path.basename(drive)])
    link_all(drive, copy, ["velodyne_points", *but])
    link_all(drive + "/velodyne_points", copy + "/velodyne_points", ["data"])
    os.makedirs(copy + "/velodyne_points/data")
    for name in os.listdir(drive + "/velodyne_points/data"):
        points = np.fromfile(f"{drive}/velodyne_points/data/{name}", np.float32).reshape(-1, 4)
        points[choose(points, ring_numbers(points))].tofile(f"{copy}/velodyne_points/data/{name}")
    return copy
