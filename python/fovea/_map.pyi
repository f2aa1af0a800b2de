"""Maps and their points. Poses are 4x4 matrices T_to_from, lengths m, angles rad, times ns."""
import os
import pathlib
from typing import Any, Dict, Iterator, List, Mapping, Optional, Sequence, Tuple, Union, overload

import numpy as np
import numpy.typing as npt

from . import Camera, Drive
from ._meta import Meta
from ._records import ExportedMap
from ._records import FrameRecord as FrameRecord
from ._records import MergeFigures, RenderFigures

__all__ = ["Map", "Points", "merge"]

_Path = Union[str, "os.PathLike[str]"]
_Floats = npt.NDArray[np.float32]
_Doubles = npt.NDArray[np.float64]
_Bytes = npt.NDArray[np.uint8]
_TileId = Tuple[int, int, int, int]  # submap, x, y, z
_Choice = Union[slice, Sequence[bool], Sequence[int], npt.NDArray[np.bool_],
                npt.NDArray[np.integer[Any]]]

class Points:
    """N points of a map as columns: read-only arrays, which live on after this object and the map.

    Columns are the memory itself, but color and xyz are copies.
    """

    @property
    def position(self) -> _Floats:
        """N x 3, m, relative to origin."""
    @property
    def origin(self) -> _Doubles:
        """3, m: what positions are relative to, in their frame; 0 in the frame `local`."""
    @property
    def xyz(self) -> _Doubles:
        """N x 3, m: origin + position, a copy that can be written."""
    @property
    def color(self) -> _Bytes:
        """N x 3, RGB in the exposure of exports; of meaning where camera is not -1. A copy."""
    @property
    def camera(self) -> npt.NDArray[np.int8]:
        """N: number of the camera that colored the point, or -1."""
    @property
    def frame(self) -> npt.NDArray[np.int32]:
        """N: number of the frame that the point comes from."""
    @property
    def range(self) -> _Floats:
        """N, m, from the sensor that measured or saw the point."""
    @property
    def incidence(self) -> _Floats:
        """N, rad, between view ray and normal; NaN where unknown."""
    @property
    def interpolated(self) -> _Bytes:
        """N: 1 if made by upsampling, 0 if measured."""
    @property
    def views(self) -> _Bytes:
        """N: images that gave the color; 255: or more."""
    @property
    def spread(self) -> _Bytes:
        """N: RMS of the images' differences, gray values."""
    @property
    def weight(self) -> npt.NDArray[np.uint16]:
        """N: sum of the images' weights."""
    @property
    def reason(self) -> _Bytes:
        """N: why the point is in the map (docs/map-format.md)."""
    @property
    def intensity(self) -> Optional[_Floats]:
        """N, LiDAR reflectance 0 to 1; None in a map without."""
    def __len__(self) -> int: ...
    @overload
    def __getitem__(self, key: Union[int, np.integer[Any]]) -> np.void:
        """One row of to_structured(). IndexError outside of the points."""
    @overload
    def __getitem__(self, key: _Choice) -> Points:
        """A slice shares the memory; a mask (N bool) and an array of indices copy the points.

        IndexError for a mask of another length and an index outside of the points.
        """
    def to_structured(self) -> npt.NDArray[np.void]:
        """N rows with a field for each column, of the column's name and type: a copy.

        Positions are relative to origin, as in the column.
        """
    def __array__(
        self, dtype: Optional[npt.DTypeLike] = None, copy: Optional[bool] = None
    ) -> npt.NDArray[Any]:
        """to_structured(), for np.asarray(points)."""

class Map:
    """A map file, read on demand. As a context manager it is closed at the end.

    InputError if the file is missing or damaged, or is no map; so do all functions. Threads take
    turns with one object.
    """

    def __init__(self, path: _Path) -> None: ...
    def __fspath__(self) -> str: ...
    def __enter__(self) -> Map: ...
    def __exit__(self, *args: object) -> None: ...
    def close(self) -> None:
        """Closes the file. Points that were read stay; reading on is a ValueError."""
    @property
    def closed(self) -> bool:
        """Whether close() was called."""
    @property
    def path(self) -> pathlib.Path:
        """The file's name."""
    @property
    def meta(self) -> Meta:
        """What the map states about itself: texts by key, and typed attributes."""
    @property
    def frames(self) -> List[FrameRecord]:
        """A FrameRecord for each frame, by number."""
    @property
    def submaps(self) -> _Doubles:
        """N x 4 x 4: T_local_submap by number."""
    @property
    def size(self) -> int:
        """Number of points."""
    def __len__(self) -> int:
        """Number of points."""
    def tiles(self) -> Dict[_TileId, int]:
        """Number of points of each tile, by (submap, x, y, z)."""
    def tile(self, id: _TileId) -> Points:
        """The points of a tile, in the frame of its submap. InputError if it is not there."""
    def __iter__(self) -> Iterator[Tuple[_TileId, Points]]:
        """The tiles of one committed state, in the frames of their submaps."""
    def points(self, where: str = "", *, box: Optional[npt.ArrayLike] = None) -> Points:
        """The points that pass, in the frame `local`.

        where: as in "views >= 2 and range < 10" (docs/exports.md); "" for all.
        box: two corners, ((x0, y0, z0), (x1, y1, z1)), m, borders included. Of tiles outside the
        box nothing is read.

        ConfigError for conditions that are not understood and a box without a volume; ValueError
        for a box of another shape.
        """
    def render_drive(
        self,
        output: _Path,
        poses: npt.ArrayLike,
        *,
        cameras: Optional[Mapping[str, Camera]] = None,
        lidar: Optional[str] = None,
        rate: float = 10.0,
        reach: float = 80.0,
        exposure: str = "auto",
        threads: int = 0,
        force: bool = False,
    ) -> RenderFigures:
        """Writes a drive of what cameras and a LiDAR see, as `fovea render --poses` does.

        poses: N x 4 x 4, T_local_lidar of the frames. cameras: by the names of their folders. lidar:
        name of a data sheet, such as 'hdl64' (docs/rendering.md). rate: frames a second. reach:
        how far is seen, m. exposure: as of export(). threads: 0 for all.

        ValueError for wrong arguments, ConfigError for an unknown lidar or exposure, OutputError
        for an output that exists or cannot be written.
        """
    def plot_top(
        self,
        ax: Optional[Any] = None,
        *,
        where: str = "",
        box: Optional[npt.ArrayLike] = None,
        pixel: float = 0.1,
    ) -> Any:
        """Draws the points that pass from above, in the frame `local`, and returns the axes.

        ax: axes of matplotlib; None: new ones. pixel: edge of a pixel, m.

        ImportError without matplotlib (`pip install matplotlib`); ValueError if there is no
        point or the picture is too large.
        """
    def export(
        self,
        output: _Path,
        format: Optional[str] = None,
        *,
        where: str = "",
        crs: str = "",
        exposure: str = "auto",
        uncolored: bool = False,
        double: bool = False,
        color_depth: int = 8,
        voxel: float = 0.05,
        max_points: int = 500_000,
        drive: Union[None, _Path, Drive] = None,
        pixel: float = 0.05,
        utc_offset: Optional[float] = None,
        force: bool = False,
    ) -> ExportedMap:
        """Writes the map in another form, as `fovea export` does (docs/exports.md).

        format: 'ply', 'pcd', 'las', 'glb', 'orthophoto' (PNG), '3dtiles', 'mesh', 'colmap', 'nerf'
        (each a folder), or, of the frames, 'tum', 'csv', 'geojson', 'frames', 'kitti-poses'; None:
        by the ending of output.
        where: as of points(). crs: 'local', 'utm' or 'ecef'. exposure: 'auto', 'map', 'frame:N' or
        stops above that of the map. uncolored: also points that no camera colored, in gray.
        double: positions of PLY and PCD. color_depth: 8 or 16 bits. voxel: edge of the triangles
        of a mesh, or of the cells of colmap and nerf with one point each, m. max_points: of colmap
        and nerf. drive: colmap and nerf write its images, too. pixel: edge of a pixel of an
        orthophoto, m. utc_offset: h that the drive's clock is ahead of UTC, for LAS. force:
        replaces the output.

        ConfigError for an option that there is not; InputError for coordinates that the map
        lacks; OutputError for an output that exists or cannot be written.
        """
    def render(
        self,
        output: Optional[_Path] = None,
        *,
        view: str = "behind",
        eye: Optional[Sequence[float]] = None,
        target: Optional[Sequence[float]] = None,
        frame: Optional[int] = None,
        width: int = 1280,
        height: int = 720,
        drive: Union[None, _Path, Drive] = None,
        camera: Optional[int] = None,
        foreign: bool = False,
        exposure: str = "",
        force: bool = False,
    ) -> _Bytes:
        """Draws a picture of the map, as `fovea render` does: height x width x 3, RGB.

        output: a PNG file to write as well. view: 'driver', 'behind' or 'above' the vehicle, or
        'map': all of it from above. eye, target: 3 numbers each, m, frame `local`: a free camera
        and the place to which it looks, instead of a view. frame: where the vehicle was; None:
        half way. drive: draws what a camera of this drive sees (camera: its number), above its
        photograph; foreign: also a drive that the map was not made of. exposure: as of export();
        "": as the photograph, else 'auto'. force: replaces the output.

        ConfigError for an option that there is not; InputError for a frame that the map lacks, or
        a drive that the map was not made of; OutputError for an output that exists or cannot be
        written.
        """
    def digest(self) -> str:
        """Hash of everything but timings: the same for the same map."""

def merge(
    first: Union[_Path, Map],
    second: Union[_Path, Map],
    output: _Path,
    *,
    memory: int = ...,
    threads: int = 0,
    force: bool = False,
) -> MergeFigures:
    """Writes a map of two maps of one place, in the first one's frame, as `fovea merge` does.

    memory: bytes for tiles. threads: 0 for all. force: replaces the output, and merges also maps
    that do not overlap.

    InputError for maps that cannot be merged, OutputError for an output that exists or cannot be
    written.
    """
