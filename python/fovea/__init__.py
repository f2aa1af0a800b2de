"""Fovea: drives (LiDAR, cameras, GPS/INS) into colored 3D point maps.

Poses are 4x4 matrices T_to_from, lengths meters, angles radians, times int nanoseconds;
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
from ._records import ExportedMap, FrameRecord, MergeFigures, RenderFigures, ViewRecord
from ._results import ColoredPoints, Images, RayVerdict, SurfaceSamples, Upsampled
from ._stages import (
    FovealRegion,
    RegistrationResult,
    ScanFit,
    color_points,
    compensate_sweep,
    foveal_points,
    ray_filter,
    register_scans,
    sample_surfaces,
    scan_fit,
    segment_ground,
    sensor_height,
    upsample,
    upsample_non_ground,
)
from .errors import ConfigError, Error, InputError, OutputError

from . import laz  # needs its packages only when it writes

__all__ = [
    "Camera",
    "CameraModel",
    "ColoredPoints",
    "ConfigError",
    "Drive",
    "DriveWriter",
    "Error",
    "ExportedMap",
    "FovealRegion",
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
    "RayVerdict",
    "RegistrationResult",
    "RenderFigures",
    "ScanFit",
    "SurfaceSamples",
    "SweepMotion",
    "SweepTiming",
    "Upsampled",
    "ViewRecord",
    "__version__",
    "color_points",
    "compensate_sweep",
    "evaluate",
    "foveal_points",
    "map_drive",
    "merge",
    "ray_filter",
    "register_scans",
    "sample_surfaces",
    "scan_fit",
    "segment_ground",
    "sensor_height",
    "upsample",
    "upsample_non_ground",
]
