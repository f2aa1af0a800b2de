"""Drives: reading one frame by frame, and writing one."""
from ._fovea import Camera, CameraModel, Drive, DriveWriter, Frame, SweepMotion, SweepTiming

__all__ = ["Camera", "CameraModel", "Drive", "DriveWriter", "Frame", "SweepMotion", "SweepTiming"]
