"""Results of the stages, and the images of a frame."""
import enum
import warnings
from typing import Dict, List, NamedTuple, Optional

import numpy as np
import numpy.typing as npt

_Floats = npt.NDArray[np.float32]
_Bytes = npt.NDArray[np.uint8]
_Bools = npt.NDArray[np.bool_]


class Upsampled(NamedTuple):
    """What upsample() returns: the points given in their order, then the new ones."""

    position: _Floats  #: M x 3, m, camera frame
    normal: _Floats  #: M x 3, unit, towards the camera; zero where unknown
    interpolated: _Bools  #: M, True for new points


class SurfaceSamples(NamedTuple):
    """What sample_surfaces() returns: points that were kept in their order, then samples."""

    position: _Floats  #: M x 3, m, camera frame
    normal: _Floats  #: M x 3, unit, towards the camera; zero where unknown
    level: _Bytes  #: M, of the cell: 0 the finest, each further one twice as large
    reason: _Bytes  #: M, the rule that admitted the point (docs/map-format.md)


class ColoredPoints(NamedTuple):
    """What color_points() returns."""

    color: _Bytes  #: N x 3, RGB; black where is_seen is False
    is_seen: _Bools  #: N, whether the image shows the place of the point


class RayVerdict(enum.IntEnum):
    """Verdict of ray_filter() on a point."""

    OUTSIDE = -1  #: of the image
    VISIBLE = 0
    OCCLUDING = 1  #: hides a point of the map
    OCCLUDED = 2
    SHARED = 3  #: a nearer point has its pixel


class Images(Dict[int, _Bytes]):
    """Images of a frame by number of the camera; those that are missing are left out.

    A place in Drive.cameras in place of a number warns, and will be a KeyError.
    """

    def __init__(self, numbers: List[int], images: List[Optional[_Bytes]]) -> None:
        super().__init__((number, image) for number, image in zip(numbers, images)
                         if image is not None)
        self._numbers, self._images = numbers, images

    def __missing__(self, key: int) -> Optional[_Bytes]:
        is_place = isinstance(key, int) and -len(self._images) <= key < len(self._images)
        if key in self._numbers or not is_place:
            raise KeyError(key)
        warnings.warn(f"Frame.images has numbers of cameras: use images[{self._numbers[key]}], not "
                      f"images[{key}]", DeprecationWarning, stacklevel=2)
        return self._images[key]
