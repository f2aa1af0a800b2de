"""Drives: reading one frame by frame, and writing one."""
import os
import pathlib
from typing import Dict, Iterator, List, Mapping, Optional, Sequence, Tuple, Union

import numpy as np
import numpy.typing as npt

from ._results import Images

__all__ = ["Camera", "CameraModel", "Drive", "DriveWriter", "Frame", "SweepMotion", "SweepTiming"]

_Path = Union[str, "os.PathLike[str]"]
_Floats = npt.NDArray[np.float32]
_Doubles = npt.NDArray[np.float64]
_FrameRange = Tuple[Optional[int], Optional[int]]

class SweepMotion:
    """How a body moves about a moment: twists in its own frame, rotation first."""

    def __init__(self, velocity: npt.ArrayLike, acceleration: npt.ArrayLike = ...) -> None:
        """velocity: 6, rad/s and m/s; acceleration: 6, rad/s^2 and m/s^2. ValueError for numbers
        that are not finite."""
    @property
    def velocity(self) -> _Doubles:
        """6, rad/s and m/s."""
    @property
    def acceleration(self) -> _Doubles:
        """6, rad/s^2 and m/s^2."""

class SweepTiming:
    """When the points of a sweep are measured, for scans without times. The defaults: KITTI's."""

    def __init__(
        self,
        *,
        period: float = 0.1,
        direction: str = "clockwise",
        start_azimuth: float = ...,
        stamp_phase: float = 0.5,
    ) -> None:
        """period: s; direction: 'clockwise' or 'counterclockwise', from above; start_azimuth: rad,
        atan2(y, x); stamp_phase: share of the sweep that is complete at the stamp. ValueError
        otherwise."""
    @property
    def period(self) -> float:
        """s."""
    @property
    def direction(self) -> str:
        """'clockwise' or 'counterclockwise', from above."""
    @property
    def start_azimuth(self) -> float:
        """rad, atan2(y, x)."""
    @property
    def stamp_phase(self) -> float:
        """Share of the sweep that is complete at the stamp."""

class Camera:
    """A pinhole camera without distortion; pixel centers at integers."""

    def __init__(
        self,
        width: int,
        height: int,
        K: npt.ArrayLike,
        T_cam_lidar: Optional[npt.ArrayLike] = None,
        index: int = 0,
    ) -> None:
        """width, height: pixels; K: 3x3, pixels; T_cam_lidar: 4x4, optical frame (z ahead), or
        None: the identity. ValueError for numbers that are no camera."""
    @property
    def index(self) -> int:
        """The drive's number for it."""
    @property
    def width(self) -> int: ...
    @property
    def height(self) -> int: ...
    @property
    def image_delay(self) -> float:
        """s, from a scan's stamp to its image; the drive's median."""
    @property
    def K(self) -> _Doubles:
        """3x3, pixels."""
    @property
    def T_cam_lidar(self) -> _Doubles:
        """4x4."""
    def at_image(self, motion: Optional[SweepMotion]) -> Camera:
        """The camera where it took the image, against the LiDAR at the scan's stamp.

        motion: of the LiDAR at the stamp, or None: it stood.
        """
    def project(self, points_cam: npt.ArrayLike) -> _Doubles:
        """Pixels of points, N x 2; NaN where a point is not in front of the camera.

        points_cam: N x 3, m, camera frame. ValueError for points that are not finite.
        """

class Frame:
    """A LiDAR sweep with its images. Arrays are read-only and not copied."""

    @property
    def index(self) -> int:
        """Its number in the drive."""
    @property
    def stamp(self) -> int:
        """ns."""
    @property
    def points(self) -> _Floats:
        """N x 3, m, LiDAR frame, as measured: not yet motion compensated."""
    @property
    def intensity(self) -> Optional[_Floats]:
        """N, 0 to 1, or None."""
    @property
    def time(self) -> Optional[_Floats]:
        """N, s from the stamp, or None."""
    @property
    def sensor(self) -> Optional[npt.NDArray[np.uint16]]:
        """N, number of the LiDAR, or None for a drive with one."""
    @property
    def dropped_points(self) -> int:
        """Points of the scan that are not finite or out of reach, and not in `points`."""
    @property
    def images(self) -> Images:
        """By number of the camera: height x width x 3 or height x width x 1 uint8. Images that are
        missing are left out."""
    @property
    def missing_images(self) -> List[str]:
        """Why images are missing, a line each."""
    @property
    def T_local_lidar(self) -> Optional[_Doubles]:
        """4x4, pose at the stamp by the drive's navigation; None without it."""
    @property
    def motion(self) -> Optional[SweepMotion]:
        """Of the LiDAR at the stamp, by the drive's navigation; None without it."""

class Drive:
    """A drive: KITTI's folders or one with a drive.toml.

    Iteration gives the frames that can be used, and warns of each that cannot. drive[i] is the
    frame with the number i of `frames`: a number of the drive, not a place, and not below 0.
    """

    def __init__(
        self,
        path: _Path,
        *,
        cameras: Sequence[int] = ...,
        frames: _FrameRange = ...,
        use_navigation: bool = True,
        use_images: bool = True,
    ) -> None:
        """cameras: numbers, in the order in which they take turns; frames: half-open, an open end
        is the drive's own. InputError for a folder that is no drive, ConfigError for a camera that
        it lacks."""
    def __fspath__(self) -> str: ...
    @property
    def path(self) -> pathlib.Path: ...
    @property
    def kind(self) -> str:
        """'kitti-raw', 'kitti-odometry' or 'generic' (with a drive.toml)."""
    @property
    def cameras(self) -> List[Camera]:
        """The chosen cameras."""
    @property
    def frames(self) -> range:
        """Numbers of the frames; some may turn out to be skipped."""
    @property
    def notes(self) -> List[str]:
        """What a user should know of the drive, a line each."""
    @property
    def sweep(self) -> SweepTiming:
        """Of scans whose points have no times."""
    @property
    def is_compensated(self) -> bool:
        """Whether the motion was undone in the scans already."""
    def load(self, index: int) -> Frame:
        """As drive[index]."""
    def __getitem__(self, index: int) -> Frame:
        """The frame of that number. IndexError beyond `frames`; InputError if it cannot be used."""
    def __len__(self) -> int:
        """Number of `frames`."""
    def __iter__(self) -> Iterator[Frame]: ...

class CameraModel:
    """A camera of a DriveWriter."""

    def __init__(
        self,
        width: int,
        height: int,
        K: npt.ArrayLike,
        T_lidar_cam: npt.ArrayLike,
        distortion_model: str = "none",
        D: Sequence[float] = ...,
    ) -> None:
        """K: 3x3, pixels, pixel centers at integers; T_lidar_cam: 4x4, optical frame (z ahead);
        distortion_model: 'none', 'plumb_bob', 'rational_polynomial' or 'equidistant', as in ROS; D:
        its coefficients. ValueError for numbers that are no camera."""

class DriveWriter:
    """Writes a drive frame by frame: the base of an adapter for another data set.

    As a context manager it closes the drive at the end, and keeps nothing after an exception.
    """

    def __init__(
        self,
        path: _Path,
        *,
        cameras: Mapping[str, CameraModel] = ...,
        force: bool = False,
        compensated: bool = False,
        further_lidars: Mapping[str, npt.ArrayLike] = ...,
        first_lidar: str = "first",
        allow_dropped: bool = False,
    ) -> None:
        """cameras: by name, their numbers follow the names; compensated: the motion was undone in
        the scans already; further_lidars: T_lidar_sensor, 4x4, by name; allow_dropped: over 10 % of
        the points may be unusable. OutputError if the folder exists (except with force)."""
    def add_scan(
        self,
        lidar: str,
        points: npt.ArrayLike,
        stamp: int,
        *,
        intensity: Optional[npt.ArrayLike] = None,
        times: Optional[npt.ArrayLike] = None,
        rings: Optional[npt.ArrayLike] = None,
    ) -> None:
        """Adds a scan of a further LiDAR, in its own frame, with columns as in add()."""
    def add(
        self,
        points: npt.ArrayLike,
        stamp: int,
        *,
        intensity: Optional[npt.ArrayLike] = None,
        times: Optional[npt.ArrayLike] = None,
        rings: Optional[npt.ArrayLike] = None,
        images: Mapping[str, Union[npt.NDArray[np.uint8], _Path]] = ...,
        image_stamps: Mapping[str, int] = ...,
        T_world_lidar: Optional[npt.ArrayLike] = None,
    ) -> None:
        """Adds the next frame. points: N x 3, m, LiDAR frame; stamp: ns; intensity: N, up to 1, 255
        or 65535; times: N, s from the stamp; rings: N; images: by camera, uint8 arrays or PNG or
        JPEG files; image_stamps: by camera, ns (default: the scan's); T_world_lidar: 4x4.
        ValueError for what is no frame, InputError for files that are no images."""
    def close(self) -> Dict[str, int]:
        """Gives the drive its name. The numbers of scans, images, poses and dropped points."""
    def __enter__(self) -> DriveWriter: ...
    def __exit__(self, type: object, value: object, traceback: object) -> None: ...
