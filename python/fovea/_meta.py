"""What a map states about itself (docs/map-format.md), with types."""
from __future__ import annotations

import sys
from typing import Any, Dict, NamedTuple, Optional, Tuple


class Origin(NamedTuple):
    """The origin of the frame `local` on WGS 84."""

    latitude: float  # degrees
    longitude: float  # degrees
    height: float  # m above the ellipsoid


def _flat(table: Dict[str, Any], prefix: str = "") -> Dict[str, Any]:
    """A table of tables with keys such as "surface.spacing_m"."""
    flat: Dict[str, Any] = {}
    for key, value in table.items():
        if isinstance(value, dict):
            flat.update(_flat(value, f"{prefix}{key}."))
        else:
            flat[prefix + key] = value
    return flat


class Meta(Dict[str, str]):
    """A dict of the texts by key, as the file has them, and the same as typed attributes.

    An attribute whose key a repaired map has lost is empty, 0, or None.
    """

    @property
    def format_version(self) -> int:
        """Version of the map's format."""
        return int(self.get("format_version", 0))

    @property
    def fovea_version(self) -> str:
        """Version of the program that wrote the map."""
        return self.get("fovea.version", "")

    @property
    def drive_name(self) -> str:
        """Name of the folder of the drive, of a merged map the first one's."""
        return self.get("drive.name", "")

    @property
    def drive_kind(self) -> str:
        """'kitti-raw', 'kitti-odometry' or 'generic'."""
        return self.get("drive.kind", "")

    @property
    def cameras(self) -> Tuple[int, ...]:
        """Numbers of the cameras that colored the map."""
        return tuple(int(number) for number in self.get("cameras", "").split(",") if number)

    @property
    def frames(self) -> range:
        """Numbers of the frames."""
        return range(int(self.get("frames.begin", 0)), int(self.get("frames.end", 0)))

    @property
    def hold_out(self) -> str:
        """Held-out frames, as map_drive(hold_out=) takes them."""
        return self.get("hold_out", "")

    @property
    def poses(self) -> str:
        """Source of the poses: 'refine', 'navigation' or 'given'."""
        return self.get("poses", "")

    @property
    def variant(self) -> str:
        """Row of the paper's tables, or ''."""
        return self.get("variant", "")

    @property
    def settings(self) -> Dict[str, Any]:
        """Settings by key, such as {"surface.spacing_m": 0.02}, as map_drive(settings=) takes them.

        RuntimeError in a Python older than 3.11, which cannot read TOML.
        """
        if sys.version_info < (3, 11):
            raise RuntimeError("the settings of a map are TOML: use Python 3.11, or meta['config']")
        import tomllib

        return _flat(tomllib.loads(self.get("config", "")))

    @property
    def notes(self) -> Tuple[str, ...]:
        """Remarks for the user."""
        return tuple(self.get("notes", "").splitlines())

    @property
    def complete(self) -> bool:
        """Whether the map has all frames."""
        return self.get("complete") == "1"

    @property
    def calibration(self) -> str:
        """'as given' or 'corrected'."""
        return self.get("calibration", "")

    @property
    def tile_size(self) -> float:
        """Edge of a tile, m."""
        return float(self.get("map.tile_size_m", 0))

    @property
    def georeferenced(self) -> bool:
        """Whether the frame `local` is east, north, up at `origin`."""
        return self.get("georeferenced") == "1"

    @property
    def origin(self) -> Optional[Origin]:
        """The origin of the frame `local`, or None in a map without georeference."""
        keys = ("origin.latitude_deg", "origin.longitude_deg", "origin.height_m")
        if not self.georeferenced or any(key not in self for key in keys):
            return None
        return Origin(*(float(self[key]) for key in keys))

    @property
    def crop(self) -> Optional[str]:
        """The region that `fovea crop` kept, or None."""
        return self.get("crop")

    @property
    def repair(self) -> Optional[str]:
        """What `fovea repair` left out, or None."""
        return self.get("repair")
