"""Fovea: drives (LiDAR, cameras, GPS/INS) into coloured 3D point maps.

Poses are 4x4 matrices T_to_from, lengths metres, angles radians, times int nanoseconds;
docs/python.md has examples.
"""
from . import _processor  # first of all: the compiled module may not run here
from ._drive import (
    Camera,
    CameraModel,
    Drive,
    DriveWriter,
    Frame,
    SweepMotion,
    SweepTiming,
)
from ._fovea import __version__
from ._map import Map, Points, merge
from ._meta import Meta, Origin
from ._records import ExportedMap, FrameRecord, MergeFigures, ViewRecord
from ._mapping import (
    LiveMapper,
    LivePose,
    Localization,
    Localizer,
    Mapper,
    Progress,
    evaluate,
    map_drive,
)
from ._results import Images
from .errors import ConfigError, Error, InputError, OutputError

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
    "Images",
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
    "SweepMotion",
    "SweepTiming",
    "ViewRecord",
    "__version__",
    "evaluate",
    "map_drive",
    "merge",
]
