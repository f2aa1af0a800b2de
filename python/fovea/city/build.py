"""The commands plan, build, add and remove: from drives to the jobs that are missing, and to the manifest."""
from __future__ import annotations

import contextlib
import dataclasses
import os
import pathlib
import time
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

from ..errors import Error
from .catalog import read_catalog
from .drives import Drive, Segment, check_control, check_coordinates, check_given_once, check_session
from .folder import CityFolder
from .jobs import Job, JobMaker, map_file, poses_file
from .lock import CityLock
from .manifest import (city_of, placed_city, points_of, read_manifest, read_poses, write_jobs,
                       write_manifest)
from .names import drive_digest, name_of
from .plan import Plan, Request, make_plan, segments_of
from .problems import input_error
from .progress import Progress
from .runner import Failure, Runner, worker_count
from .settings import RunOptions, Settings


@dataclass
class Outcome:
    """What a command did."""

    plan: Plan
    manifest: dict[str, Any] | None = None
    jobs_run: int = 0
    problems: list[str] = field(default_factory=list)  # what failed, a line each


class CityBuild:
    """One command on one city, under its lock. A context manager."""

    def __init__(self, folder: CityFolder, settings: Settings, options: RunOptions) -> None:
        self.folder, self.settings, self.options = folder, settings, options
        self.maker = JobMaker(str(folder.path), settings, options)
        self.progress = Progress(options.quiet, worker_count(options))
        self._lock = CityLock(folder)
        self._runner = Runner(folder, options, self.warn)
        self._catalogs: list[Job] = []
        self._failures: list[Failure] = []
        self._problems: list[str] = []  # of drives
        self._jobs_run = 0

    def __enter__(self) -> CityBuild:
        began = time.time()
        self._lock.__enter__()
        for line in self._lock.warnings:
            self.warn(line)
        self.folder.remove_partial_files(older_than_s=began)
        return self

    def __exit__(self, *error: Any) -> None:
        try:
            self._runner.__exit__()
            if self.options.scheduler is None:  # all jobs have ended
                self.folder.remove_partial_files()
        finally:
            self._lock.__exit__(*error)

    def warn(self, line: str) -> None:
        """Prints a warning."""
        self.progress.say(f"fovea.city: warning: {line}")

    def problems(self) -> list[str]:
        """What failed so far, a line each."""
        return self._problems + [_line_of(failure) for failure in self._failures]

    def list_drives(self, paths: Sequence[str]) -> list[Drive]:
        """Catalogs drives. Those that cannot be listed, or have no georeference, become problems."""
        named = []
        seen: set[str] = set()
        for path in sorted(os.path.abspath(path) for path in paths):
            if os.path.realpath(path) in seen:
                raise input_error("a drive is given twice", path, "give each drive once")
            seen.add(os.path.realpath(path))
            digest = drive_digest(pathlib.Path(path))
            named.append((path, digest, name_of("catalog", digest, self.settings.cameras or "", self.options.version)))
        self._catalogs = [self.maker.catalog(path, name) for path, _, name in named]
        self.run_missing(self._catalogs)
        failed = {failure.job.id for failure in self._failures}
        drives = []
        for path, digest, name in named:
            if f"catalog-{name}" in failed:
                continue
            catalog = read_catalog(self.folder.path / "catalog" / f"{name}.json")
            for line in catalog.warnings:
                self.warn(f"{catalog.name}: {line}")
            if catalog.samples:
                drives.append(Drive(digest, path, name, catalog))
            else:
                self._problems.append(f"{catalog.name} is left out: it has no georeference, {path}, "
                                      "map it with GPS/INS, or state its origin (docs/drives.md)")
        return drives

    def check(self, drives: Sequence[Drive], segments: Sequence[Segment]) -> None:
        """InputError if the drives cannot become one city."""
        if not segments:
            for line in self.problems():
                self.progress.say(f"fovea.city: {line}")
            raise input_error("no drive can be part of the city", self.folder.path, "see the lines above")
        for line in check_given_once(drives):
            self.warn(line)
        check_coordinates(drives, self.settings)
        check_control(segments, self.settings)

    def write_plan(self, request: Request) -> Plan:
        """Plans, and writes jobs.json."""
        plan = make_plan(request, self.maker)
        listed = {job.id for job in plan.jobs}
        failed = [failure.job for failure in self._failures if failure.job.kind != "catalog"]
        write_jobs(self.folder, self.options.version, plan, self.settings,
                   [*self._catalogs, *(job for job in failed if job.id not in listed)], self._problems)
        return plan

    def execute(self, request: Request) -> Outcome:
        """Runs the jobs that are missing, and writes the manifest. Maps and pairs that fail are left out."""
        plan = self.write_plan(request)
        for line in plan.warnings:
            self.warn(line)
        plan, has_maps = self._make_maps(request, plan)
        if not has_maps or not self._make_poses(plan):
            return self._outcome(plan, read_manifest(self.folder))
        self._run(self._needed(plan))
        manifest = write_manifest(self.folder, plan.tiles, placed_city(plan, self.settings).json())
        return self._outcome(plan, manifest)

    def _make_maps(self, request: Request, plan: Plan) -> tuple[Plan, bool]:
        """Makes maps and pairs. Plans again without those that fail. Returns the plan, and whether a map is left."""
        while todo := [job for job in self._needed(plan) if job.kind in ("map", "pair")]:
            failures = self._run(todo)
            failed = {failure.job.id for failure in failures}
            for segment in request.segments:
                if segment.placed_by and f"map-{segment.name}" in failed:
                    raise input_error(f"a map of the city is missing and cannot be made again: {segment.text}",
                                      map_file(segment.name), f"see {self.folder.path}/logs/map-{segment.name}.log, "
                                      "or remove the drive")
            if request.fixed and any(failure.of_machine for failure in failures):
                self._problems.append("no poses are made: without these maps or pairs, they would stay so; "
                                      "run add again")
                return plan, False
            request = dataclasses.replace(request, failed=request.failed | failed)
            if all(f"map-{segment.name}" in request.failed for segment in request.segments):
                return plan, False
            plan = self.write_plan(request)
        return plan, True

    def _make_poses(self, plan: Plan) -> bool:
        """Makes the poses. Returns whether they are there."""
        todo = [job for job in self._needed(plan) if job.kind == "poses"]
        failures = self._run(todo)
        if todo and not failures:
            self._warn_of_poses(plan)
        return not failures

    def _warn_of_poses(self, plan: Plan) -> None:
        """Warns of what `fovea adjust` found: maps without a match, and matches that contradict the rest."""
        content = read_poses(self.folder, plan.poses)
        lonely = [segment.text for segment, placed in zip(plan.segments, content["maps"])
                  if placed.get("matches") == 0 and not placed.get("fixed")]
        if len(plan.segments) > 1:
            for text in lonely:
                self.warn(f"{text} fits no other map: navigation alone places it")
        if content.get("rejected"):
            self.warn(f"{len(content['rejected'])} matches contradict the rest and are left out: "
                      f"`rejected` in {poses_file(plan.poses)}")

    def run_missing(self, jobs: Sequence[Job]) -> None:
        """Runs the jobs whose outputs are missing."""
        missing = [job for job in jobs if not self.folder.has(job.output)]
        self.progress.expect(missing)
        self._run(missing)

    def _outcome(self, plan: Plan, manifest: dict[str, Any] | None) -> Outcome:
        return Outcome(plan, manifest, self._jobs_run, self.problems())

    def _needed(self, plan: Plan) -> list[Job]:
        needed = needed_jobs(plan.jobs, self.folder)
        self.progress.expect(needed)
        return needed

    def _run(self, jobs: Sequence[Job]) -> list[Failure]:
        if not jobs:
            return []

        ended: list[Job] = []

        def on_done(job: Job) -> None:
            self._jobs_run += 1
            ended.append(job)
            points = 0
            with contextlib.suppress(Error):  # write_manifest() reports it
                points = points_of(self.folder.path / job.output) if job.kind == "tile" else 0
            self.progress.job_done(job, points)

        self.progress.begin_stage()
        failures = self._runner.run(jobs, on_done, self.progress.show)
        self.progress.end_stage()
        failures += [Failure(job, f"it ended well, but {job.output} does not show here: run the command again",
                             of_machine=True) for job in ended if not self.folder.has(job.output)]
        self._failures += failures
        return failures


def needed_jobs(jobs: Sequence[Job], folder: CityFolder) -> list[Job]:
    """The jobs that are missing, in their order. Maps and pairs are missing only if a missing file needs them."""
    needed, wanted = [], set[str]()
    for job in reversed(jobs):
        if job.kind == "root" or folder.has(job.output):
            continue
        if job.kind in ("tile", "poses") or job.id in wanted:
            needed.append(job)
            wanted.update(job.after)
    return needed[::-1]


def plan(build: CityBuild, paths: Sequence[str]) -> Plan:
    """Plans the city of some drives."""
    drives = build.list_drives(paths)
    return build.write_plan(_new_city(build, drives))


def build_city(build: CityBuild, paths: Sequence[str]) -> Outcome:
    """Makes the city of some drives."""
    drives = build.list_drives(paths)
    return build.execute(_new_city(build, drives))


def _new_city(build: CityBuild, drives: Sequence[Drive]) -> Request:
    segments = [segment for drive in drives for segment in segments_of(drive, build.settings, build.options.version)]
    build.check(drives, segments)
    check_session(drives, build.settings.session)
    return Request(build.settings, tuple(segments))


def add_drives(build: CityBuild, manifest: dict[str, Any], paths: Sequence[str]) -> Outcome:
    """Adds drives to a city. Its poses stay as they are."""
    city = city_of(manifest, build.folder)
    there = {segment.drive.digest: segment.drive for segment in city.segments}
    segments = list(city.segments)
    known = {(segment.drive.digest, segment.begin, segment.end) for segment in segments}
    for drive in build.list_drives(paths):
        same = [old for old in there.values() if os.path.realpath(old.folder) == os.path.realpath(drive.folder)]
        if same and same[0].digest != drive.digest:
            raise input_error("files of the drive have changed since it became a part of the city", drive.folder,
                              f"run `remove {drive.catalog.name}` first")
        drive = there.setdefault(drive.digest, drive)
        segments += [segment for segment in segments_of(drive, build.settings, build.options.version)
                     if (drive.digest, segment.begin, segment.end) not in known]
    build.check(list(there.values()), segments)
    return build.execute(Request(build.settings, tuple(segments), city.fixed()))


def remove_drives(build: CityBuild, manifest: dict[str, Any], names: Sequence[str]) -> Outcome:
    """Takes drives, given by name or folder, out of a city. The poses of the others stay as they are."""
    city = city_of(manifest, build.folder)
    drives = {segment.drive.digest: segment.drive for segment in city.segments}
    removed = set()
    for name in names:
        found = [drive for drive in drives.values()
                 if drive.catalog.name == name or os.path.realpath(drive.folder) == os.path.realpath(name)]
        if len(found) != 1:
            has = "has no drive" if not found else f"has {len(found)} drives with the name"
            raise input_error(f"the city {has} {name}", build.folder.path, "give the folder of a drive in it")
        removed.add(found[0].digest)
    kept = tuple(segment for segment in city.segments if segment.drive.digest not in removed)
    if not kept:
        raise input_error("no drive would be left", build.folder.path, "remove the folder of the city instead")
    return build.execute(Request(build.settings, kept, city.fixed()))


def _line_of(failure: Failure) -> str:
    job = failure.job
    return f"the job {job.kind} of {job.subject} failed: {failure.reason}; log: {job.log}"
