"""The stages of the method as functions over arrays. All raise ValueError for arrays of other
shapes, points that are not finite, and numbers out of range."""
from typing import Optional, Sequence, Tuple

import numpy as np
import numpy.typing as npt

from ._drive import Camera, SweepMotion, SweepTiming
from ._results import ColoredPoints, SurfaceSamples, Upsampled

__all__ = [
    "FovealRegion",
    "RegistrationResult",
    "ScanFit",
    "color_points",
    "compensate_sweep",
    "foveal_points",
    "ray_filter",
    "register_scans",
    "scan_fit",
    "sample_surfaces",
    "segment_ground",
    "sensor_height",
    "upsample",
    "upsample_non_ground",
]

_Floats = npt.NDArray[np.float32]
_Doubles = npt.NDArray[np.float64]
_Bools = npt.NDArray[np.bool_]

def compensate_sweep(
    points: npt.ArrayLike,
    motion: SweepMotion,
    *,
    times: Optional[npt.ArrayLike] = None,
    sweep: SweepTiming = ...,
) -> _Floats:
    """Deskews a scan: moves each point to where it was in the LiDAR frame at the scan's stamp.

    points: N x 3, m, LiDAR frame, as measured; motion: of the LiDAR at the stamp; times: N, s from
    the stamp, or None: by azimuth and `sweep`. Returns N x 3, m.
    """

def segment_ground(
    points: npt.ArrayLike,
    *,
    method: str = "height",
    sensor_height: float = 1.73,
    tolerance: float = 0.25,
    ransac_iterations: int = 200,
    ransac_max_tilt: float = 10,
    seed: int = 1,
) -> _Bools:
    """Which points of a scan are ground: N bool.

    points: N x 3, m, LiDAR frame; method: 'height' (a threshold) or 'ransac' (a plane);
    sensor_height: m above the road; tolerance: m; ransac_max_tilt: degrees.
    """

def sensor_height(points: npt.ArrayLike) -> Optional[float]:
    """Height of the LiDAR above the plane below it with the most points, m; or None.

    points: N x 3, m, LiDAR frame.
    """

def upsample(
    points_cam: npt.ArrayLike, camera: Camera, *, rate: int = 2, max_edge: float = 0.3
) -> Upsampled:
    """Adds centroids of the triangles of a cloud's Delaunay triangulation in the image.

    points_cam: N x 3, m, camera frame, all more than 0.1 m in front of the camera; rate: how often
    centroids are inserted, 0 to 5; max_edge: m, longest edge of a filled triangle.
    """

def upsample_non_ground(
    points: npt.ArrayLike,
    is_ground: npt.ArrayLike,
    cameras: Sequence[Camera],
    *,
    rate: int = 2,
    max_edge: float = 0.3,
) -> _Floats:
    """Densifies the points in view of cameras except ground points: M x 3, m, LiDAR frame.

    points: N x 3, m, LiDAR frame; is_ground: N bool.
    """

class RegistrationResult:
    """What register_scans() returns."""

    @property
    def T_target_source(self) -> _Doubles:
        """4x4, m; the guess if not converged."""
    @property
    def converged(self) -> bool: ...
    @property
    def iterations(self) -> int: ...
    @property
    def pairs(self) -> int:
        """Of points, in the last iteration."""
    @property
    def rms_distance(self) -> float:
        """m, of these pairs."""
    @property
    def degenerate_directions(self) -> int:
        """Of six, that the scene leaves open."""
    @property
    def information(self) -> _Doubles:
        """6x6, of a twist of the source in its own frame, rotation first (1/rad^2, 1/m^2). Too
        optimistic: it treats the pairs as independent."""

class ScanFit:
    """What scan_fit() returns."""

    @property
    def vertical(self) -> int:
        """Points on vertical surfaces, one in each cell of 0.25 m."""
    @property
    def overlap(self) -> float:
        """Share of them with a counterpart within 1 m."""
    @property
    def on_plane(self) -> float:
        """Share of these within 0.1 m of their counterpart's plane."""
    @property
    def shows_one_place(self) -> bool:
        """Whether both scans show one place, and the motion is right."""

def scan_fit(
    target: npt.ArrayLike, source: npt.ArrayLike, T_target_source: npt.ArrayLike
) -> ScanFit:
    """How the vertical surfaces of two registered scans lie on each other.

    target, source: as those of register_scans(), z up; T_target_source: 4x4, m.
    """

def register_scans(
    target: npt.ArrayLike,
    source: npt.ArrayLike,
    guess: Optional[npt.ArrayLike] = None,
    *,
    method: str = "gicp",
    max_iterations: int = 100,
    max_points: int = 0,
    max_distance: float = 1.0,
    voxel: float = 0.25,
    neighbors: int = 10,
    robust_width: float = 0.0,
    prior: Optional[npt.ArrayLike] = None,
    prior_sigma: Optional[npt.ArrayLike] = None,
) -> RegistrationResult:
    """Aligns a scan to another one by iterative closest point.

    target, source: N x 3 and M x 3, m, each in the frame of its sensor; points that are not finite
    are left out. guess: T_target_source, 4x4, within max_distance of the truth; None: the identity.
    method: 'gicp', 'point_to_point' or 'point_to_plane'. max_points: of each scan, 0: all.
    max_distance: m, pairs further apart are not used. voxel: m, one point is kept in each cell of
    this edge, 0: all. neighbors: of a point, for its normal.
    robust_width: m, 0: no robust kernel. prior: T_target_source, with prior_sigma: 6, rad and m.
    """

class FovealRegion:
    """The part of a camera's view that is mapped, at one moment."""

    def __init__(
        self,
        camera: Camera,
        *,
        near_range: float = 3.0,
        far_range: float = 18.0,
        periphery_range: float = 0.0,
        slices: Sequence[Tuple[float, float, float, float]] = ...,
        lidar_origins: Sequence[npt.ArrayLike] = ...,
    ) -> None:
        """near_range, far_range: m from the LiDAR; periphery_range: m, 0: there is none; slices:
        (azimuth_min, azimuth_max, elevation_min, elevation_max), rad about the optical axis, right
        and up, their union counts, none: the whole view; lidar_origins: 3 each, m, LiDAR frame."""
    def contains(self, points_cam: npt.ArrayLike) -> _Bools:
        """Which points lie in the region: N bool. points_cam: N x 3, m, camera frame."""

def foveal_points(points: npt.ArrayLike, region: FovealRegion) -> _Floats:
    """The points of a scan that are in a region: M x 3, m, in the frame of its camera.

    points: N x 3, m, LiDAR frame.
    """

def ray_filter(
    points_cam: npt.ArrayLike,
    camera: Camera,
    *,
    map_points_cam: Optional[npt.ArrayLike] = None,
    window: int = 5,
    outlier_rate: float = 2.0,
) -> npt.NDArray[np.int8]:
    """Which points of a scan a camera sees: N, each a RayVerdict.

    points_cam: N x 3, m, camera frame; map_points_cam: M x 3, points that are in the map already;
    window: pixels, odd; outlier_rate: deviations, smaller rejects more.
    """

def sample_surfaces(
    points_cam: npt.ArrayLike,
    camera: Camera,
    *,
    spacing: float = 0.02,
    max_edge: float = 0.4,
    planar_edge: float = 1.0,
    planar_angle: float = ...,
    max_per_pixel: float = 4,
    full_density_range: float = ...,
    T_grid_cam: Optional[npt.ArrayLike] = None,
) -> SurfaceSamples:
    """Samples the surfaces in a camera's view on a regular grid.

    points_cam: N x 3, m, camera frame, all more than 0.1 m in front of the camera; spacing: m, of
    the samples; max_edge: m, triangles with shorter edges are surface; planar_edge: m, the same
    where the surface is flat up to planar_angle (rad); max_per_pixel: samples, 0: no limit;
    full_density_range: m; T_grid_cam: 4x4, pose of the grid, or None: that of the camera.
    """

def color_points(
    points_cam: npt.ArrayLike,
    image: npt.NDArray[np.uint8],
    camera: Camera,
    *,
    mask: Optional[npt.ArrayLike] = None,
    sampling: str = "bilinear",
) -> ColoredPoints:
    """Colors of points from the image at their projections.

    points_cam: N x 3, m, camera frame; image: height x width x 3 or height x width, of the camera's
    size; mask: height x width bool, False where the image does not show the scene, or a uint8
    picture, dark there; sampling: 'bilinear' or 'nearest'. Does not test whether another point
    hides a point: ray_filter() does.
    """
