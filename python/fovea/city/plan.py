"""Plans a city: from drives and settings to jobs. It writes no file, and the order of the drives does not matter."""
from __future__ import annotations

import dataclasses
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from .catalog import sections_of
from .drives import Drive, Segment
from .ground import Cell, Place, Plane, Point, cells_within
from .jobs import Job, JobMaker
from .names import name_of
from .pairs import allowance_of, choose_pairs, lonely_drives
from .settings import Settings

_SAMPLE_SPACING_M = 5.0  # of a drive's path


@dataclass(frozen=True)
class FixedPoses:
    """Poses of an earlier run that stay as they are."""

    name: str
    maps: tuple[str, ...]  # in their order in the file
    origin: Place  # of the plan that made them


@dataclass(frozen=True)
class Request:
    """What to plan: segments with `placed_by` have their poses in `fixed`."""

    settings: Settings
    segments: tuple[Segment, ...]
    fixed: FixedPoses | None = None
    failed: frozenset[str] = frozenset()  # ids of maps and pairs that cannot be made


@dataclass(frozen=True)
class Plan:
    """Jobs in an order in which they can run, without catalogs."""

    segments: tuple[Segment, ...]  # those that are in the city, all with `placed_by`, in the order of the poses
    poses: str
    origin: Place  # of the grid while planning: the begin of the first map's path, within meters of its origin
    jobs: tuple[Job, ...]
    tiles: dict[Cell, str]  # files by their place
    warnings: tuple[str, ...]


def segments_of(drive: Drive, settings: Settings, version: str) -> list[Segment]:
    """The segments that a drive is mapped in, with their names."""
    return [
        Segment(name_of("map", drive.digest, section.begin, section.end, settings.map_key, version), drive,
                section.begin, section.end, section.samples)
        for section in sections_of(drive.catalog, settings.segment_length_m)]


def make_plan(request: Request, maker: JobMaker) -> Plan:
    """Plans all jobs. At least one segment has not failed."""
    settings, failed = request.settings, request.failed
    segments = sorted((segment for segment in request.segments if f"map-{segment.name}" not in failed),
                      key=lambda segment: segment.name)
    origin = request.fixed.origin if request.fixed else segments[0].samples[0].place
    plane = Plane(origin)
    paths = [[plane.project(sample.place) for sample in segment.samples] for segment in segments]
    chosen = [(segments[a], segments[b]) for a, b in choose_pairs(segments, paths)]
    pairs = {name_of("pair", a.name, b.name): (a, b) for a, b in chosen}
    pairs = {name: pair for name, pair in sorted(pairs.items()) if f"pair-{name}" not in failed}
    poses_job = _poses_job(request, segments, list(pairs), maker)
    poses = poses_job.id.removeprefix("poses-") if poses_job else request.fixed.name if request.fixed else ""
    placed = tuple(dataclasses.replace(segment, placed_by=segment.placed_by or poses) for segment in segments)
    tiles = _tile_jobs(placed, paths, settings, poses, maker)
    jobs = [*map(maker.map, segments), *(maker.pair(name, a, b) for name, (a, b) in pairs.items()),
            *([poses_job] if poses_job else []), *tiles.values(), maker.root(tiles.values(), poses)]
    return Plan(placed, poses, origin, tuple(jobs), {tile: job.output for tile, job in tiles.items()},
                tuple(_warnings(segments, pairs.values())))


def _poses_job(request: Request, segments: Sequence[Segment], pairs: Sequence[str], maker: JobMaker) -> Job | None:
    """The job that makes the poses of the segments. None: the fixed poses are those."""
    maps = [segment.name for segment in segments]
    fixed = request.fixed
    if fixed and all(segment.placed_by for segment in segments):
        if list(fixed.maps) == maps:
            return None
        return maker.kept_poses(name_of("kept poses", fixed.name, maps),
                                [fixed.maps.index(name) for name in maps], fixed.name)
    key = [maps, pairs, fixed.name if fixed else "", request.settings.poses_key]
    return maker.poses(name_of("poses", *key), maps, pairs, fixed.name if fixed else None)


def _tile_jobs(segments: Sequence[Segment], paths: Sequence[Sequence[Point]], settings: Settings, poses: str,
               maker: JobMaker) -> dict[Cell, Job]:
    reached: dict[Cell, list[Segment]] = {}
    range_m = settings.range_m
    for segment, path in zip(segments, paths):
        for tile in _tiles_of(path, range_m + allowance_of(segment), settings.tile_size_m):
            reached.setdefault(tile, []).append(segment)
    jobs = {}
    for tile in sorted(reached):
        maps = reached[tile]
        session = _session_of(maps, settings.session)
        name = name_of("tile", *tile, settings.tile_size_m, session, [[m.name, m.placed_by] for m in maps])
        jobs[tile] = maker.tile(tile, name, [m.name for m in maps], poses, session)
    return jobs


def _tiles_of(path: Sequence[Point], reach: float, tile_size: float) -> set[Cell]:
    """All tiles that may have points of a segment."""
    tiles: set[Cell] = set()
    for x, y in path:
        tiles.update(cells_within(x, y, reach + _SAMPLE_SPACING_M, tile_size))
    return tiles


def _session_of(maps: Sequence[Segment], session: str) -> str:
    """The session of a tile: "best" where the chosen day or drive has no map in reach."""
    if session in ("best", "latest"):
        return session
    is_there = any(session in (m.drive.catalog.session, m.drive.catalog.name) for m in maps)
    return session if is_there else "best"


def _warnings(segments: Sequence[Segment], pairs: Iterable[tuple[Segment, Segment]]) -> list[str]:
    names = {segment.drive.digest: segment.drive.catalog.name for segment in segments}
    if len(names) < 2:
        return []
    numbers = {segment.name: number for number, segment in enumerate(segments)}
    lonely = lonely_drives(segments, ((numbers[a.name], numbers[b.name]) for a, b in pairs))
    return [f"{name} is near no other drive: navigation alone places it"
            for name in sorted(names[digest] for digest in lonely)]
