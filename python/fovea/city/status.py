"""`status CITY/`: what is done, missing and failed, and the disk space. It also works while a build runs."""
from __future__ import annotations

import shutil
from collections.abc import Sequence

from . import costs
from .build import needed_jobs
from .folder import FOLDERS, CityFolder
from .jobs import STAGES, Job
from .lock import is_dead, read_lock
from .manifest import JobList, read_jobs, read_manifest
from .progress import size_text
from .worker import error_line


def status_lines(folder: CityFolder) -> list[str]:
    """The report, line by line."""
    manifest = read_manifest(folder)
    lines = []
    if manifest is None:
        lines.append(f"{folder.path}: no manifest yet")
    else:
        points = sum(tile["points"] for tile in manifest["tiles"])
        lines.append(f"{folder.path}: revision {manifest['revision']}, {len(manifest['drives'])} drives, "
                     f"{len(manifest['tiles'])} tiles, {points / 1e6:.1f} million points")
    holder = read_lock(folder.lock)
    if holder is not None:
        state = "a build has ended without a result" if is_dead(holder) else "a build runs"
        lines.append(f"{state}: process {holder['pid']} on {holder['host']} since {holder['start']}")
    if not folder.jobs.exists():
        return [*lines, "no jobs are planned yet"]
    listed = read_jobs(folder)
    return lines + _job_lines(folder, listed) + _disk_lines(folder, listed.jobs)


def _job_lines(folder: CityFolder, listed: JobList) -> list[str]:
    lines = []
    failed: list[Job] = []
    needed = {job.id for job in needed_jobs(listed.jobs, folder)}
    for kind in STAGES[:STAGES.index("root")]:
        jobs = [job for job in listed.jobs if job.kind == kind]
        if not jobs:
            continue
        missing = [job for job in jobs if not folder.has(job.output)]
        failed_here = [job for job in missing if _exit_code(folder, job) not in (None, 0)]
        failed += failed_here
        missing_count = sum(job.id in needed for job in missing if job not in failed_here)
        lines.append(f"{kind:8s} {len(jobs) - len(missing):6d} done, {missing_count:6d} missing, "
                     f"{len(failed_here):6d} failed")
    for job in failed:
        log = folder.path / job.log
        lines.append(f"failed: {job.kind} of {job.subject}: {error_line(str(log))}; log: {log}")
    return lines + [f"problem: {line}" for line in listed.problems]


def _exit_code(folder: CityFolder, job: Job) -> int | None:
    """Of the job's last run; None if it has not ended or never began."""
    try:
        last = (folder.path / job.log).read_text(errors="replace").splitlines()[-1]
        words = last.split()
        return int(words[3]) if last.startswith("# exit code ") else None
    except (OSError, IndexError, ValueError):
        return None


def _disk_lines(folder: CityFolder, jobs: Sequence[Job]) -> list[str]:
    used = sum(folder.bytes_of(name) for name in FOLDERS)
    needed = sum(_expected_bytes(folder, jobs, job) for job in needed_jobs(jobs, folder))
    free = shutil.disk_usage(folder.path).free
    line = f"disk: {size_text(used)} used, about {size_text(needed)} more for the missing jobs, {size_text(free)} free"
    return [line + (": too little" if needed > free else "")]


def _expected_bytes(folder: CityFolder, jobs: Sequence[Job], job: Job) -> float:
    """Of the output: the mean of those that exist of the same kind, weighted by the expected time."""
    if job.kind not in ("map", "tile"):
        return costs.JSON_BYTES
    sizes = [((folder.path / other.output).stat().st_size, other.expected_s)
             for other in jobs if other.kind == job.kind and folder.has(other.output)]
    if sizes:
        return sum(size for size, _ in sizes) * job.expected_s / max(sum(seconds for _, seconds in sizes), 1e-9)
    if job.kind == "tile":
        return costs.TILE_BYTES
    return costs.MAP_BYTES_PER_FRAME * job.expected_s / costs.MAP_S_PER_FRAME
