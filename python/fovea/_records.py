"""What a map keeps of its frames, and what functions of maps report."""
from ._fovea import ExportedMap, FrameRecord, MergeFigures, RenderFigures, ViewRecord

__all__ = ["ExportedMap", "FrameRecord", "MergeFigures", "RenderFigures", "ViewRecord"]
