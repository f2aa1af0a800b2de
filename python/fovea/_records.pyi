"""What a map keeps of its frames, and what functions of maps report."""
from typing import Dict, List, Optional

import numpy as np
import numpy.typing as npt

__all__ = ["ExportedMap", "FrameRecord", "MergeFigures", "RenderFigures", "ViewRecord"]

_Doubles = npt.NDArray[np.float64]

class ViewRecord:
    """The image of one camera in a frame."""

    @property
    def camera(self) -> int:
        """Number of the camera."""
    @property
    def stamp(self) -> Optional[int]:
        """When the image was taken, ns, or None."""
    @property
    def log2_gain(self) -> Optional[_Doubles]:
        """3: base-2 logarithms of the gains of red, green and blue, image = map * gain; or None."""

class FrameRecord:
    """What a map keeps of a frame of its drive."""

    @property
    def index(self) -> int:
        """Number of the frame."""
    @property
    def stamp(self) -> Optional[int]:
        """Of the scan, ns, or None."""
    @property
    def status(self) -> str:
        """'mapped', 'held-out' or 'skipped'."""
    @property
    def note(self) -> str:
        """Why it was skipped, or another remark; or ''."""
    @property
    def T_local_lidar(self) -> _Doubles:
        """4x4, refined pose; of a skipped frame between its neighbors'."""
    @property
    def T_local_lidar_navigation(self) -> Optional[_Doubles]:
        """4x4, pose by GPS/INS, or None."""
    @property
    def T_odom_lidar(self) -> _Doubles:
        """4x4, pose in the frame that never jumps."""
    @property
    def submap(self) -> int:
        """Number of the submap; -1 of a skipped frame."""
    @property
    def velocity(self) -> Optional[_Doubles]:
        """6: twist of the LiDAR in its own frame, rotation first (rad/s, m/s), or None."""
    @property
    def acceleration(self) -> Optional[_Doubles]:
        """6: change of the velocity (rad/s^2, m/s^2), or None."""
    @property
    def views(self) -> List[ViewRecord]:
        """One for each image, by camera."""
    @property
    def figures(self) -> Dict[str, float]:
        """Figures of the stages by name."""
    @property
    def milliseconds(self) -> Dict[str, float]:
        """Wall time of the stages by name."""

class ExportedMap:
    """What Map.export() wrote."""

    @property
    def points(self) -> int:
        """Points, or vertices of the points that a mesh was made of."""
    @property
    def uncolored_left_out(self) -> int:
        """Points that no camera colored."""
    @property
    def filtered_out(self) -> int:
        """Points that do not meet the conditions."""
    @property
    def tiles(self) -> int:
        """Tiles of a tileset."""
    @property
    def triangles(self) -> int:
        """Triangles of a mesh."""
    @property
    def width(self) -> int:
        """Of an orthophoto, pixels."""
    @property
    def height(self) -> int:
        """Of an orthophoto, pixels."""
    @property
    def images(self) -> int:
        """Images of colmap and nerf."""
    @property
    def held_out(self) -> int:
        """Images of held-out frames among them."""

class MergeFigures:
    """What merge() did."""

    @property
    def points(self) -> int:
        """Points of the result."""
    @property
    def drives_added(self) -> int:
        """Drives of the second map that the first one did not have."""
    @property
    def georeferenced(self) -> bool:
        """Whether the maps were placed by their georeference or a common drive first."""
    @property
    def submaps_met(self) -> int:
        """Submaps of the second map with the first map around them."""
    @property
    def submaps_registered(self) -> int:
        """Submaps of these that were registered; 0: the maps lie as the first guess says."""
    @property
    def moved(self) -> float:
        """m, median motion of the registered submaps."""
    @property
    def points_added(self) -> int:
        """New points of the second map."""
    @property
    def points_known(self) -> int:
        """Points of the second map on a surface of the first one, left out."""
    @property
    def points_fused(self) -> int:
        """Points of the first map that got a color of the second one."""
    @property
    def log2_gain(self) -> _Doubles:
        """3: base-2 logarithms of the gains of red, green, blue, second map = first map * gain."""

class RenderFigures:
    """What Map.render_drive() wrote."""

    @property
    def frames(self) -> int: ...
    @property
    def covered(self) -> float:
        """Mean share of the images' pixels that show something."""
    @property
    def points(self) -> float:
        """Mean number of points of the scans."""
    @property
    def blank(self) -> int:
        """Images without anything."""
    @property
    def empty(self) -> int:
        """Scans without a point, which are not written."""
