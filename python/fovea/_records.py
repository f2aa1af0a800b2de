"""What a map keeps of its frames, and what functions of maps report."""
from ._fovea import ExportedMap, FrameRecord, MergeFigures, ViewRecord

__all__ = ["ExportedMap", "FrameRecord", "MergeFigures", "ViewRecord"]
