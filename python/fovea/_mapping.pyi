"""The mappers, the localizer and the scores."""
import os
from typing import Any, Callable, Dict, Optional, Sequence, Tuple, Union

import numpy as np
import numpy.typing as npt

from ._drive import Drive, Frame
from ._map import Points
from ._records import FrameRecord

__all__ = [
    "LiveMapper",
    "LivePose",
    "Localization",
    "Localizer",
    "Mapper",
    "Progress",
    "evaluate",
    "map_drive",
]

_Path = Union[str, "os.PathLike[str]"]
_Doubles = npt.NDArray[np.float64]
_TileId = Tuple[int, int, int, int]  # submap, x, y, z
_FrameRange = Tuple[Optional[int], Optional[int]]

class Progress:
    """How far a run of map_drive() is, after a frame."""

    @property
    def done(self) -> int:
        """Frames."""
    @property
    def total(self) -> int:
        """Frames."""
    @property
    def points(self) -> int:
        """In the map so far."""
    @property
    def frame(self) -> FrameRecord:
        """The frame just done."""

class Mapper:
    """Maps a drive frame by frame, all in memory; map_drive() makes files."""

    def __init__(
        self, drive: Drive, *, preset: str = "default", settings: Dict[str, Any] = ...
    ) -> None:
        """preset: 'default', 'paper' or 'realtime'; settings: values by key (docs/settings.md).
        ConfigError for others."""
    def process(self, frame: Frame, *, held_out: bool = False) -> FrameRecord:
        """Maps the drive's next frame. A held-out one gets a pose, and adds nothing. ValueError for
        a frame of another drive, or one that is not later."""
    @property
    def size(self) -> int:
        """Number of points so far."""
    @property
    def submaps(self) -> _Doubles:
        """T_local_submap as of the last frame, N x 4 x 4."""
    def tiles(self) -> Dict[_TileId, Points]:
        """The points so far by (submap, x, y, z), in the frames of their submaps, m. Not changed by
        later frames."""

class LivePose:
    """A frame of a LiveMapper when it has its pose."""

    @property
    def index(self) -> int: ...
    @property
    def stamp(self) -> int:
        """ns, of the scan."""
    @property
    def state(self) -> str:
        """'tracked', 'lost' or 'restarted'."""
    @property
    def T_local_lidar(self) -> _Doubles:
        """4x4."""
    @property
    def covariance(self) -> Optional[_Doubles]:
        """6x6, of a twist of the LiDAR in its own frame, rotation first (rad^2, m^2); or None."""

class LiveMapper:
    """Maps scans, images and poses while a program's threads measure them (docs/live.md).

    The data of each sensor come in the order of their stamps, the sensors in any order, from any
    thread. What ends the map early is raised by the next add function and by close().
    """

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
    ) -> None:
        """drive: a drive.toml that describes the sensors, as a path or as text of several lines;
        max_wait: s from the arrival of a scan, for its images and poses; every_frame: add functions
        wait if the mapper is behind; expects_navigation: the map begins when poses or positions are
        there; record: a folder, for the frames as a drive; on_pose: called after each frame in the
        tracker's thread, must be fast, and may not call the mapper. ConfigError and InputError for
        a drive.toml that cannot be used, OutputError for outputs that exist (except with force or
        resume)."""
    def add_scan(
        self,
        stamp: int,
        points: npt.ArrayLike,
        *,
        intensity: Optional[npt.ArrayLike] = None,
        times: Optional[npt.ArrayLike] = None,
        rings: Optional[npt.ArrayLike] = None,
        lidar: str = "",
    ) -> None:
        """Adds a sweep. stamp: ns; points: N x 3, m, LiDAR frame, as measured, or N x 4 with
        intensity; intensity: N; times: N, s from the stamp; rings: N; lidar: its name, of
        several."""
    def add_image(
        self,
        camera: str,
        stamp: int,
        image: Union[npt.NDArray[np.uint8], bytes],
        *,
        exposure: Optional[float] = None,
    ) -> None:
        """Adds an image. camera: its name; stamp: ns; image: height x width x 3 or height x width,
        or the bytes of a PNG or JPEG file; exposure: s, times the amplification."""
    def add_pose(self, stamp: int, T_world_body: npt.ArrayLike) -> None:
        """Adds a pose of the body, 4x4, m, in a world that never jumps. stamp: ns."""
    def add_position(
        self,
        stamp: int,
        latitude: float,
        longitude: float,
        altitude: float,
        *,
        accuracy: float = 0.0,
        roll_pitch_yaw: Optional[npt.ArrayLike] = None,
    ) -> None:
        """Adds a position of the antenna. stamp: ns; latitude, longitude: degrees; altitude: m;
        accuracy: m, 0: not known, infinite: no fix; roll_pitch_yaw: 3, rad, yaw 0 is east."""
    def add_imu(
        self,
        stamp: int,
        angular_velocity: npt.ArrayLike,
        acceleration: npt.ArrayLike,
        *,
        R_enu_imu: Optional[npt.ArrayLike] = None,
    ) -> None:
        """Adds a record of the IMU, in its own frame. stamp: ns; angular_velocity: 3, rad/s;
        acceleration: 3, m/s^2, gravity included; R_enu_imu: 3x3, orientation."""
    def add_wheel_speed(self, stamp: int, speed: float) -> None:
        """Adds a speed of the body ahead, m/s. stamp: ns."""
    def close(self) -> Dict[str, Any]:
        """Waits until the map has all frames, and returns the figures of `fovea map --report`.
        Ctrl-C ends the map with the frames at hand, and is a KeyboardInterrupt."""
    @property
    def missing(self) -> str:
        """What the beginning of the map waits for; empty: nothing."""
    @property
    def figures(self) -> Dict[str, int]:
        """What came and what was not used, so far, by name."""
    def __enter__(self) -> LiveMapper: ...
    def __exit__(self, type: object, value: object, traceback: object) -> None: ...

class Localization:
    """Where one scan was taken."""

    @property
    def index(self) -> int:
        """The frame's."""
    @property
    def stamp(self) -> Optional[int]:
        """ns, or None."""
    @property
    def state(self) -> str:
        """'localized', 'lost' or 'outside' (the map has next to nothing there)."""
    @property
    def T_local_lidar(self) -> Optional[_Doubles]:
        """4x4, in the map's frame at the scan's stamp; None unless localized."""
    @property
    def covariance(self) -> Optional[_Doubles]:
        """6x6, of a twist of the LiDAR in its own frame, rotation first (rad^2, m^2); None unless
        localized."""
    @property
    def health(self) -> float:
        """How well scan and map agree, 0 to 1 (docs/localization.md)."""
    @property
    def found(self) -> bool:
        """Whether the place was searched for, not followed from the scan before."""
    @property
    def degenerate_directions(self) -> int:
        """Of six, that the scene leaves open: predicted, not measured."""

class Localizer:
    """Registers the scans of a drive to a map or a city, one after the other."""

    def __init__(
        self,
        map: _Path,
        drive: Drive,
        *,
        use_navigation: bool = True,
        T_local_lidar: Optional[npt.ArrayLike] = None,
    ) -> None:
        """map: a map file, or a city's folder; T_local_lidar: 4x4, of the first scan. InputError
        for a map that is missing or damaged."""
    def localize(self, frame: Frame) -> Localization:
        """The drive's next scan. ValueError for a frame of another drive; InputError if the map is
        damaged there."""

def map_drive(
    drive: Union[_Path, Drive],
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
    """Maps a drive into a map file, as `fovea map` does, and returns its report.

    drive: a folder, or a Drive with its cameras and frames. callback: called after each frame; what
    it raises ends the run, and resume=True continues it. InputError if no frame is usable,
    ConfigError for settings that there are not, OutputError if the output exists (except with force
    or resume)."""

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
    """Scores a map against its drive: the keys of `fovea evaluate --json` (docs/report.md).

    protocol: 'held-out', 'cross-camera', 'in-sample', 'in-sample-nav' or, of simulated drives,
    'truth'; foreign: also a drive that the map was not made of. InputError if nothing can be
    scored."""
