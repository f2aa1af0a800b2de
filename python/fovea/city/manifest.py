"""The manifest of a city (city.json, manifests/N.json) and its plan (jobs.json)."""
from __future__ import annotations

import pathlib
import sqlite3
import urllib.parse
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any

from .catalog import read_catalog
from .drives import Drive, Segment
from .folder import CityFolder, read_json, write_json
from .ground import Cell, Place
from .jobs import Job, map_file, poses_file
from .plan import FixedPoses, Plan
from .problems import input_error
from .settings import Settings

_VERSION = 1
_REMEDY = "run build again"
_COPY = "copy the newest file of manifests/ that is whole to city.json"


@dataclass(frozen=True)
class PlacedCity:
    """The maps of a city and what placed them: what `add` and `remove` begin with."""

    settings: Settings
    segments: tuple[Segment, ...]
    poses: str
    origin: Place  # of the plan

    def json(self) -> dict[str, Any]:
        """For the manifest and for jobs.json."""
        drives: dict[str, dict[str, Any]] = {}
        for segment in self.segments:
            drive = segment.drive
            entry = drives.setdefault(drive.digest, {
                "digest": drive.digest, "path": drive.folder, "catalog": drive.catalog_name, "maps": []})
            entry["maps"].append({"name": segment.name, "frames": [segment.begin, segment.end],
                                  "placed_by": segment.placed_by})
        return {"settings": self.settings.json(), "poses": self.poses, "origin": _json_of(self.origin),
                "drives": [drives[digest] for digest in sorted(drives)]}

    def fixed(self) -> FixedPoses:
        """Its poses, to keep."""
        return FixedPoses(self.poses, tuple(sorted(segment.name for segment in self.segments)), self.origin)

    @staticmethod
    def from_json(content: dict[str, Any], folder: CityFolder) -> PlacedCity:
        """Reads the catalogs, too."""
        segments = []
        for entry in content["drives"]:
            catalog = read_catalog(folder.path / "catalog" / f"{entry['catalog']}.json")
            drive = Drive(entry["digest"], entry["path"], entry["catalog"], catalog)
            for item in entry["maps"]:
                begin, end = item["frames"]
                samples = tuple(sample for sample in catalog.samples if begin <= sample.frame < end)
                segments.append(Segment(item["name"], drive, begin, end, samples, item["placed_by"]))
        return PlacedCity(Settings.from_json(content["settings"]), tuple(segments), content["poses"],
                          _place_of(content["origin"]))


def placed_city(plan: Plan, settings: Settings) -> PlacedCity:
    """The city that a plan makes."""
    return PlacedCity(settings, plan.segments, plan.poses, plan.origin)


@dataclass(frozen=True)
class JobList:
    """Content of jobs.json."""

    jobs: tuple[Job, ...]
    tiles: dict[Cell, str]
    city: dict[str, Any]  # PlacedCity.json()
    problems: tuple[str, ...]  # of drives that are not in the plan


def write_jobs(folder: CityFolder, version: str, plan: Plan, settings: Settings, others: Iterable[Job],
               problems: Sequence[str]) -> None:
    """Writes jobs.json; `others` are jobs besides those of the plan."""
    jobs = sorted((*others, *plan.jobs), key=lambda job: job.stage)
    write_json({**json_of_jobs(folder, version, jobs), "problems": list(problems),
                "tiles": [{"x": x, "y": y, "file": file} for (x, y), file in sorted(plan.tiles.items())],
                "plan": placed_city(plan, settings).json()}, folder.jobs)


def json_of_jobs(folder: CityFolder, version: str, jobs: Iterable[Job]) -> dict[str, Any]:
    """What each list of jobs has, for any engine; `version` is that of the program."""
    return {"fovea_city_jobs": _VERSION, "program": version, "city": str(folder.path),
            "jobs": [job.json() for job in jobs]}


def read_jobs(folder: CityFolder) -> JobList:
    """InputError if jobs.json is missing, damaged or of another version."""
    content = read_json(folder.jobs, "the list of jobs", "fovea_city_jobs", _VERSION, _REMEDY)
    try:
        return JobList(tuple(map(Job.from_json, content["jobs"])),
                       {(tile["x"], tile["y"]): tile["file"] for tile in content["tiles"]}, content["plan"],
                       tuple(content["problems"]))
    except (KeyError, TypeError, IndexError) as error:
        raise input_error(f"the list of jobs is damaged ({error})", folder.jobs, _REMEDY) from error


def read_manifest(folder: CityFolder) -> dict[str, Any] | None:
    """The newest manifest, None before the first one. InputError if it is damaged or of another version."""
    return _manifest_in(folder.manifest, _COPY) if folder.manifest.exists() else None


def read_revision(folder: CityFolder, revision: int) -> dict[str, Any]:
    """The manifest of a revision. InputError if it is missing, damaged or of another version."""
    return _manifest_in(folder.path / "manifests" / f"{revision}.json", "remove the file")


def _manifest_in(file: pathlib.Path, remedy: str) -> dict[str, Any]:
    content = read_json(file, "the manifest of the city", "fovea_city", _VERSION, remedy)
    missing = {"revision", "tiles", "plan"} - content.keys()
    if missing:
        raise input_error(f"the manifest of the city is damaged: it has no {min(missing)}", file, remedy)
    return content


def city_of(manifest: dict[str, Any], folder: CityFolder) -> PlacedCity:
    """The city of a manifest."""
    try:
        return PlacedCity.from_json(manifest["plan"], folder)
    except (KeyError, TypeError, ValueError) as error:
        raise input_error(f"the manifest of revision {manifest['revision']} is damaged ({error})", folder.path,
                          _COPY) from error


def write_manifest(folder: CityFolder, tiles: dict[Cell, str], city: dict[str, Any]) -> dict[str, Any]:
    """Writes the next revision, with the tiles that exist. Nothing is written if nothing has changed.

    @return the newest manifest
    """
    old = read_manifest(folder)
    revision = old["revision"] + 1 if old else 1
    placed = PlacedCity.from_json(city, folder)
    known = {tile["file"]: tile for tile in old["tiles"]} if old else {}
    entries = []
    for (x, y), file in sorted(tiles.items()):
        if not folder.has(file):
            continue
        if file in known:
            entries.append(known[file])
        elif points := points_of(folder.path / file):
            size = (folder.path / file).stat().st_size
            entries.append({"x": x, "y": y, "file": file, "points": points, "bytes": size, "revision": revision})
    content = {
        "fovea_city": _VERSION, "revision": revision, "origin": read_poses(folder, placed.poses)["origin"],
        "tile_size_m": placed.settings.tile_size_m, "session": placed.settings.session,
        "poses": poses_file(placed.poses), "drives": _drives_of(placed), "tiles": entries, "plan": city}
    if old and {**content, "revision": 0} == {**old, "revision": 0}:
        return old
    write_json(content, folder.path / "manifests" / f"{revision}.json")
    write_json(content, folder.manifest)
    return content


def _drives_of(city: PlacedCity) -> list[dict[str, Any]]:
    drives: dict[str, dict[str, Any]] = {}
    for segment in sorted(city.segments, key=lambda segment: (segment.drive.catalog.name, segment.drive.digest,
                                                              segment.begin)):
        catalog = segment.drive.catalog
        entry = drives.setdefault(segment.drive.digest, {
            "name": catalog.name, "path": segment.drive.folder, "length_m": catalog.length_m,
            "frames": catalog.end - catalog.begin, "maps": []})
        entry["maps"].append(map_file(segment.name))
    return list(drives.values())


def points_of(tile: pathlib.Path) -> int:
    """How many points a map file has. InputError if it cannot be read."""
    address = f"file:{urllib.parse.quote(str(tile))}?immutable=1"
    try:
        connection = sqlite3.connect(address, uri=True)
        try:
            return int(connection.execute("SELECT TOTAL(points) FROM tiles").fetchone()[0])
        finally:
            connection.close()
    except sqlite3.Error as error:
        raise input_error(f"the tile cannot be read ({error})", tile, "remove the file, and run build again") from error


def read_poses(folder: CityFolder, poses: str) -> dict[str, Any]:
    """A file of poses. InputError if it is damaged or of another version."""
    file, remedy = folder.path / poses_file(poses), "remove the file, and run build again"
    content = read_json(file, "the file of poses", "fovea_poses", 1, remedy)
    try:
        _place_of(content["origin"])
        list(content["maps"])
    except (KeyError, TypeError) as error:
        raise input_error("the file of poses is damaged", file, remedy) from error
    return content


def _json_of(place: Place) -> dict[str, float]:
    return {"latitude_deg": place.latitude_deg, "longitude_deg": place.longitude_deg, "height_m": place.height_m}


def _place_of(content: dict[str, Any]) -> Place:
    return Place(float(content["latitude_deg"]), float(content["longitude_deg"]), float(content["height_m"]))
