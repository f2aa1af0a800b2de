"""An adapter: scans, images and poses of any data set become a drive that Fovea maps."""
import pathlib
import sys
from typing import Iterator, Tuple

import fovea
import numpy as np
import numpy.typing as npt

Points = npt.NDArray[np.float32]
Pose = npt.NDArray[np.float64]


def read_frames(folder: pathlib.Path) -> Iterator[Tuple[int, Points, pathlib.Path, Pose]]:
    """Yours: time stamp (ns), points (x y z intensity), image file and pose of each frame."""
    poses = np.loadtxt(folder / "poses.txt").reshape(-1, 3, 4)
    stamps = np.loadtxt(folder / "stamps.txt", dtype=np.int64)
    for number, (stamp, pose) in enumerate(zip(stamps, poses)):
        points = np.fromfile(folder / f"{number}.bin", np.float32).reshape(-1, 4)
        yield int(stamp), points, folder / f"{number}.png", np.vstack([pose, [0, 0, 0, 1]])


folder, output = map(pathlib.Path, sys.argv[1:])
K = np.loadtxt(folder / "K.txt")
T_lidar_cam = np.loadtxt(folder / "T_lidar_cam.txt")
camera = fovea.CameraModel(width=64, height=48, K=K, T_lidar_cam=T_lidar_cam)

with fovea.DriveWriter(output, cameras={"front": camera}) as writer:
    for stamp, points, image, T_world_lidar in read_frames(folder):
        writer.add(points[:, :3], stamp, intensity=points[:, 3], images={"front": image},
                   T_world_lidar=T_world_lidar)

drive = fovea.Drive(output)
print(f"{len(drive.frames)} frames, camera {drive.cameras[0].index}")
