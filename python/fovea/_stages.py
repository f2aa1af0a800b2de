"""The stages of the method as functions over arrays."""
from ._fovea import (
    FovealRegion,
    RegistrationResult,
    color_points,
    compensate_sweep,
    foveal_points,
    ray_filter,
    register_scans,
    sample_surfaces,
    segment_ground,
    sensor_height,
    upsample,
    upsample_non_ground,
)

__all__ = [
    "FovealRegion",
    "RegistrationResult",
    "color_points",
    "compensate_sweep",
    "foveal_points",
    "ray_filter",
    "register_scans",
    "sample_surfaces",
    "segment_ground",
    "sensor_height",
    "upsample",
    "upsample_non_ground",
]
