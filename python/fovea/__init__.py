"""Fovea: drives (LiDAR, cameras, GPS/INS) into coloured 3D point maps.

Poses are 4x4 matrices T_to_from, lengths metres, angles radians, times int nanoseconds;
docs/python.md has examples.
"""
from . import _processor  # first of all: the compiled module may not run here
from ._fovea import (
    Camera,
    CameraModel,
    Drive,
    DriveWriter,
    Frame,
    FrameRecord,
    LiveMapper,
    LivePose,
    Localization,
    Localizer,
    Map,
    Mapper,
    Points,
    Progress,
    ViewRecord,
    __version__,
    evaluate,
    map_drive,
)
from .errors import ConfigError, Error, InputError, OutputError

__all__ = [
    "Camera",
    "CameraModel",
    "ConfigError",
    "Drive",
    "DriveWriter",
    "Error",
    "Frame",
    "FrameRecord",
    "InputError",
    "LiveMapper",
    "LivePose",
    "Localization",
    "Localizer",
    "Map",
    "Mapper",
    "OutputError",
    "Points",
    "Progress",
    "ViewRecord",
    "__version__",
    "evaluate",
    "map_drive",
]
