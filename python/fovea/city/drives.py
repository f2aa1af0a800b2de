"""Drives of a city, the maps they become, and the checks of drives that become one city."""
from __future__ import annotations

import math
import os
from collections.abc import Callable, Sequence
from dataclasses import dataclass

from .catalog import Catalog, Sample
from .ground import Plane
from .problems import config_error, input_error
from .settings import Settings

_DEFAULT_ACCURACY_M = 0.5  # of navigation that states none, as `fovea adjust` takes it
_SAME_PLACE_M = 3.0


@dataclass(frozen=True)
class Drive:
    """A drive of a city."""

    digest: str  # of its files, see names.drive_digest()
    folder: str
    catalog_name: str  # CITY/catalog/NAME.json
    catalog: Catalog

    @property
    def accuracy_m(self) -> float:
        """One sigma of its navigation."""
        return _DEFAULT_ACCURACY_M if self.catalog.accuracy_m is None else self.catalog.accuracy_m


@dataclass(frozen=True)
class Segment:
    """Frames [begin, end) of a drive that one job maps."""

    name: str  # of the map
    drive: Drive
    begin: int
    end: int
    samples: tuple[Sample, ...]
    placed_by: str | None = None  # name of the poses that placed it first; None: not placed yet

    @property
    def text(self) -> str:
        """For messages."""
        return f"{self.drive.catalog.name} frames {self.begin}:{self.end}"


def check_given_once(drives: Sequence[Drive]) -> list[str]:
    """InputError if two drives are one. Returns warnings: two drives that may be one."""
    warnings = []
    seen: dict[str, Drive] = {}  # by folder, and by digest
    stamps: dict[str, list[Drive]] = {}
    for drive in sorted(drives, key=lambda drive: drive.folder):
        for key in (os.path.realpath(drive.folder), drive.digest):
            same = seen.setdefault(key, drive)
            if same is not drive:
                raise _given_twice(same, drive)
        fingerprint = drive.catalog.stamps_fingerprint
        others = stamps.setdefault(fingerprint, []) if fingerprint else []
        for other in others:
            if not _have_one_path(other.catalog, drive.catalog):
                continue  # stamps may count from the begin of a drive
            if other.catalog.calibration_fingerprint == drive.catalog.calibration_fingerprint:
                raise _given_twice(other, drive)
            warnings.append(f"{other.folder} and {drive.folder} have the same time stamps and path, and other "
                            "calibrations: if they are one drive, give it once")
        others.append(drive)
    return warnings


def _have_one_path(a: Catalog, b: Catalog) -> bool:
    """At the begin, in the middle and at the end. The navigation is the same, the lever arms may differ."""
    if not a.samples or len(a.samples) != len(b.samples):
        return False
    plane = Plane(a.samples[0].place)
    return all(math.dist(plane.project(a.samples[k].place), plane.project(b.samples[k].place)) < _SAME_PLACE_M
               for k in (0, len(a.samples) // 2, -1))


def _given_twice(first: Drive, second: Drive) -> Exception:
    where = first.folder if first.folder == second.folder else f"{first.folder} and {second.folder}"
    return input_error("a drive is given twice", where, "give each drive once")


def check_coordinates(drives: Sequence[Drive], settings: Settings) -> None:
    """InputError if the drives differ in datum, epoch or type of heights, or if only some of them state it."""
    _check_same(drives, "datum", "--datum", settings.datum, lambda catalog: catalog.datum)
    _check_same(drives, "epoch of the datum", "--epoch", settings.epoch_year, lambda catalog: catalog.epoch_year)
    _check_same(drives, "type of heights", "--heights", settings.height_type, lambda catalog: catalog.height_type)


def _check_same(drives: Sequence[Drive], what: str, option: str, given: object,
                value_of: Callable[[Catalog], object]) -> None:
    by_value: dict[object, list[str]] = {}
    for drive in drives:
        value = value_of(drive.catalog)
        by_value.setdefault(given if value is None else value, []).append(drive.catalog.name)
    if len(by_value) < 2:
        return
    groups = "; ".join(f"{'not stated' if value is None else value}: {_shortened(names)}"
                       for value, names in sorted(by_value.items(), key=str))
    if None in by_value:
        raise input_error(f"not all drives state the {what}", groups,
                          f"state it in all drives (docs/drives.md), or give {option} for those that do not")
    raise input_error(f"the drives differ in the {what}", groups,
                      "convert the coordinates of some of them, or build two cities")


def _shortened(names: list[str]) -> str:
    shown = sorted(names)[:3]
    return ", ".join(shown) + (f" and {len(names) - 3} more" if len(names) > 3 else "")


def check_session(drives: Sequence[Drive], session: str) -> None:
    """ConfigError if no drive has the session."""
    sessions = {"best", "latest", *(drive.catalog.name for drive in drives),
                *(drive.catalog.session for drive in drives)}
    if session not in sessions:
        raise config_error(f'no drive has the session "{session}"', "--session",
                           "give best, latest, a recording day or the name of a drive")


def check_control(segments: Sequence[Segment], settings: Settings) -> None:
    """InputError if a surveyed point names a drive that becomes several maps: its coordinates have no one frame."""
    if settings.control is None:
        return
    maps: dict[str, int] = {}
    for segment in segments:
        maps[segment.drive.catalog.name] = maps.get(segment.drive.catalog.name, 0) + 1
    for name in _maps_of_points(settings.control):
        if maps.get(name, 1) > 1:
            raise input_error(f"a surveyed point is in the drive {name}, which becomes {maps[name]} maps",
                              settings.control, "give a larger --segment-length, or the identity of one of its maps")


def _maps_of_points(file: str) -> list[str]:
    try:
        with open(file, encoding="utf-8") as lines:
            rows = [[cell.strip() for cell in line.split(",")] for line in lines if line.strip()]
    except (OSError, UnicodeDecodeError) as error:
        raise input_error("the surveyed points cannot be read", file, "give a CSV file (docs/city.md)") from error
    if not rows or "map" not in rows[0]:
        raise input_error("the surveyed points have no column map", file, "give a CSV file (docs/city.md)")
    column = rows[0].index("map")
    return [row[column] for row in rows[1:] if len(row) > column]
