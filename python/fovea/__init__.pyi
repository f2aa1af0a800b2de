"""Fovea: drives (LiDAR, cameras, GPS/INS) into coloured 3D point maps.

Poses are 4x4 matrices T_to_from, lengths metres, angles radians, times int nanoseconds.
"""
import os
import pathlib
from typing import (
    Any,
    Callable,
    Dict,
    Iterator,
    List,
    Mapping,
    Optional,
    Sequence,
    Tuple,
    Union,
)

import numpy as np
import numpy.typing as npt

from ._map import Map as Map
from ._map import Points as Points
from ._map import merge as merge
from ._meta import Meta as Meta
from ._meta import Origin as Origin
from ._records import ExportedMap as ExportedMap
from ._records import FrameRecord as FrameRecord
from ._records import MergeFigures as MergeFigures
from ._records import ViewRecord as ViewRecord
from .errors import ConfigError as ConfigError
from .errors import Error as Error
from .errors import InputError as InputError
from .errors import OutputError as OutputError

__all__ = [
    "Camera",
    "CameraModel",
    "ConfigError",
    "Drive",
    "DriveWriter",
    "Error",
    "ExportedMap",
    "Frame",
    "FrameRecord",
    "InputError",
    "LiveMapper",
    "LivePose",
    "Localization",
    "Localizer",
    "Map",
    "Mapper",
    "MergeFigures",
    "Meta",
    "Origin",
    "OutputError",
    "Points",
    "Progress",
    "ViewRecord",
    "__version__",
    "evaluate",
    "map_drive",
    "merge",
]

__version__: str

_Path = Union[str, "os.PathLike[str]"]
_Floats = npt.NDArray[np.float32]
_Doubles = npt.NDArray[np.float64]
_Bytes = npt.NDArray[np.uint8]
_TileId = Tuple[int, int, int, int]  # submap, x, y, z
_FrameRange = Tuple[Optional[int], Optional[int]]

class Camera:
    """A pinhole camera; pixel centres at integers."""

    @property
    def index(self) -> int: ...
    @property
    def width(self) -> int: ...
    @property
    def height(self) -> int: ...
    @property
    def image_delay(self) -> float: ...
    @property
    def K(self) -> _Doubles: ...
    @property
    def T_cam_lidar(self) -> _Doubles: ...

class Frame:
    """A LiDAR sweep with its images. Arrays are read-only and not copied."""

    @property
    def index(self) -> int: ...
    @property
    def stamp(self) -> int: ...
    @property
    def points(self) -> _Floats: ...
    @property
    def intensity(self) -> Optional[_Floats]: ...
    @property
    def time(self) -> Optional[_Floats]: ...
    @property
    def sensor(self) -> Optional[npt.NDArray[np.uint16]]: ...
    @property
    def dropped_points(self) -> int: ...
    @property
    def images(self) -> List[Optional[_Bytes]]: ...
    @property
    def missing_images(self) -> List[str]: ...

class Drive:
    """A drive. Iteration gives the frames that can be used and warns of each that cannot."""

    def __init__(
        self,
        path: _Path,
        *,
        cameras: Sequence[int] = ...,
        frames: _FrameRange = ...,
        use_navigation: bool = True,
        use_images: bool = True,
    ) -> None: ...
    def __fspath__(self) -> str: ...
    @property
    def path(self) -> pathlib.Path: ...
    @property
    def kind(self) -> str: ...
    @property
    def cameras(self) -> List[Camera]: ...
    @property
    def frames(self) -> range: ...
    @property
    def notes(self) -> List[str]: ...
    def load(self, index: int) -> Frame: ...
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
    ) -> None: ...

class DriveWriter:
    """Writes a drive frame by frame: the base of an adapter for another data set."""

    def __init__(
        self,
        path: _Path,
        *,
        cameras: Mapping[str, CameraModel] = ...,
        force: bool = False,
        compensated: bool = False,
        further_lidars: Mapping[str, npt.ArrayLike] = ...,
        first_lidar: str = "first",
    ) -> None: ...
    def add_scan(
        self,
        lidar: str,
        points: npt.ArrayLike,
        stamp: int,
        *,
        intensity: Optional[npt.ArrayLike] = None,
        times: Optional[npt.ArrayLike] = None,
        rings: Optional[npt.ArrayLike] = None,
    ) -> None: ...
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
    ) -> None: ...
    def close(self) -> Dict[str, int]: ...
    def __enter__(self) -> DriveWriter: ...
    def __exit__(self, type: object, value: object, traceback: object) -> None: ...

class Progress:
    """How far a run of map_drive() is, after a frame."""

    @property
    def done(self) -> int: ...
    @property
    def total(self) -> int: ...
    @property
    def points(self) -> int: ...
    @property
    def frame(self) -> FrameRecord: ...

class Mapper:
    """Maps a drive frame by frame, all in memory; map_drive() makes files."""

    def __init__(
        self, drive: Drive, *, preset: str = "default", settings: Dict[str, Any] = ...
    ) -> None: ...
    def process(self, frame: Frame, *, held_out: bool = False) -> FrameRecord: ...
    @property
    def size(self) -> int: ...
    @property
    def submaps(self) -> _Doubles: ...
    def tiles(self) -> Dict[_TileId, Points]: ...

class LivePose:
    """A frame of a LiveMapper when it has its pose."""

    @property
    def index(self) -> int: ...
    @property
    def stamp(self) -> int: ...
    @property
    def state(self) -> str: ...
    @property
    def T_local_lidar(self) -> _Doubles: ...
    @property
    def covariance(self) -> Optional[_Doubles]: ...

class LiveMapper:
    """Maps scans, images and poses while a program's threads measure them."""

    def __init__(
        self,
        drive: _Path,
        output: _Path,
        *,
        preset: str = "default",
        settings: Dict[str, Any] = ...,
        cameras: Sequence[int] = ...,
        threads: int = 0,
        resume: bool = False,
        force: bool = False,
        max_wait: float = 0.3,
        every_frame: bool = False,
        expects_navigation: bool = False,
        record: Optional[_Path] = None,
        on_pose: Optional[Callable[[LivePose], object]] = None,
    ) -> None: ...
    def add_scan(
        self,
        stamp: int,
        points: npt.ArrayLike,
        *,
        intensity: Optional[npt.ArrayLike] = None,
        times: Optional[npt.ArrayLike] = None,
        rings: Optional[npt.ArrayLike] = None,
        lidar: str = "",
    ) -> None: ...
    def add_image(
        self,
        camera: str,
        stamp: int,
        image: Union[npt.NDArray[np.uint8], bytes],
        *,
        exposure: Optional[float] = None,
    ) -> None: ...
    def add_pose(self, stamp: int, T_world_body: npt.ArrayLike) -> None: ...
    def add_position(
        self,
        stamp: int,
        latitude: float,
        longitude: float,
        altitude: float,
        *,
        accuracy: float = 0.0,
        roll_pitch_yaw: Optional[npt.ArrayLike] = None,
    ) -> None: ...
    def add_imu(
        self,
        stamp: int,
        angular_velocity: npt.ArrayLike,
        acceleration: npt.ArrayLike,
        *,
        R_enu_imu: Optional[npt.ArrayLike] = None,
    ) -> None: ...
    def add_wheel_speed(self, stamp: int, speed: float) -> None: ...
    def close(self) -> Dict[str, Any]: ...
    @property
    def missing(self) -> str: ...
    @property
    def figures(self) -> Dict[str, int]: ...
    def __enter__(self) -> LiveMapper: ...
    def __exit__(self, type: object, value: object, traceback: object) -> None: ...

class Localization:
    """Where one scan was taken."""

    @property
    def index(self) -> int: ...
    @property
    def stamp(self) -> Optional[int]: ...
    @property
    def state(self) -> str: ...
    @property
    def T_local_lidar(self) -> Optional[_Doubles]: ...
    @property
    def covariance(self) -> Optional[_Doubles]: ...
    @property
    def health(self) -> float: ...
    @property
    def found(self) -> bool: ...
    @property
    def degenerate_directions(self) -> int: ...

class Localizer:
    """Registers the scans of a drive to a map, one after the other."""

    def __init__(
        self,
        map: _Path,
        drive: Drive,
        *,
        use_navigation: bool = True,
        T_local_lidar: Optional[npt.ArrayLike] = None,
    ) -> None: ...
    def localize(self, frame: Frame) -> Localization: ...

def map_drive(
    drive: _Path,
    output: _Path,
    *,
    preset: str = "default",
    settings: Dict[str, Any] = ...,
    hold_out: str = "",
    frames: _FrameRange = ...,
    cameras: Sequence[int] = ...,
    threads: int = 0,
    calibrate: bool = False,
    resume: bool = False,
    force: bool = False,
    callback: Optional[Callable[[Progress], object]] = None,
) -> Dict[str, Any]:
    """Maps a drive into a map file, as `fovea map` does, and returns its report."""

def evaluate(
    map: _Path,
    drive: _Path,
    protocol: str = "held-out",
    *,
    cameras: Sequence[int] = ...,
    hold_out: str = "",
    foreign: bool = False,
    threads: int = 0,
) -> Dict[str, Any]:
    """Scores a map against its drive: the keys of `fovea evaluate --json`."""
