"""Fovea: drives (LiDAR, cameras, GPS/INS) into colored 3D point maps.

Poses are 4x4 matrices T_to_from, lengths meters, angles radians, times int nanoseconds.
"""
from . import laz as laz
from ._drive import Camera as Camera
from ._drive import CameraModel as CameraModel
from ._drive import Drive as Drive
from ._drive import DriveWriter as DriveWriter
from ._drive import Frame as Frame
from ._drive import SweepMotion as SweepMotion
from ._drive import SweepTiming as SweepTiming
from ._map import Map as Map
from ._map import Points as Points
from ._map import merge as merge
from ._meta import Meta as Meta
from ._meta import Origin as Origin
from ._mapping import LiveMapper as LiveMapper
from ._mapping import LivePose as LivePose
from ._mapping import Localization as Localization
from ._mapping import Localizer as Localizer
from ._mapping import Mapper as Mapper
from ._mapping import Progress as Progress
from ._mapping import evaluate as evaluate
from ._mapping import map_drive as map_drive
from ._records import ExportedMap as ExportedMap
from ._records import FrameRecord as FrameRecord
from ._records import MergeFigures as MergeFigures
from ._records import RenderFigures as RenderFigures
from ._records import ViewRecord as ViewRecord
from ._results import ColoredPoints as ColoredPoints
from ._results import Images as Images
from ._results import RayVerdict as RayVerdict
from ._results import SurfaceSamples as SurfaceSamples
from ._results import Upsampled as Upsampled
from ._stages import FovealRegion as FovealRegion
from ._stages import RegistrationResult as RegistrationResult
from ._stages import ScanFit as ScanFit
from ._stages import color_points as color_points
from ._stages import compensate_sweep as compensate_sweep
from ._stages import foveal_points as foveal_points
from ._stages import ray_filter as ray_filter
from ._stages import register_scans as register_scans
from ._stages import sample_surfaces as sample_surfaces
from ._stages import scan_fit as scan_fit
from ._stages import segment_ground as segment_ground
from ._stages import sensor_height as sensor_height
from ._stages import upsample as upsample
from ._stages import upsample_non_ground as upsample_non_ground
from .errors import ConfigError as ConfigError
from .errors import Error as Error
from .errors import InputError as InputError
from .errors import OutputError as OutputError

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
    "ScanFit",
    "RenderFigures",
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

__version__: str
