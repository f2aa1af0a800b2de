"""The mappers, the localizer and the scores."""
from ._fovea import (
    LiveMapper,
    LivePose,
    Localization,
    Localizer,
    Mapper,
    Progress,
    evaluate,
    map_drive,
)

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
