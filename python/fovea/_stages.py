"""The stages of the method as functions over arrays."""
from ._fovea import (
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

__all__ = [
    "FovealRegion",
    "RegistrationResult",
    "ScanFit",
    "color_points",
    "compensate_sweep",
    "foveal_points",
    "ray_filter",
    "register_scans",
    "sample_surfaces",
    "scan_fit",
    "segment_ground",
    "sensor_height",
    "upsample",
    "upsample_non_ground",
]
