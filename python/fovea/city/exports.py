"""The command export: a job for each tile of a city, and one for the root of a tileset."""
from __future__ import annotations

import pathlib
from typing import Any

from .build import CityBuild
from .folder import write_json
from .jobs import Job, export_folder, export_jobs_file
from .manifest import json_of_jobs


def export_city(build: CityBuild, manifest: dict[str, Any], form: str) -> list[str]:
    """Exports the tiles of a city that have no export yet, and the root of a tileset.

    @return what failed, a line each
    """
    parts, root = _jobs(build, manifest, form)
    build.run_missing(parts)
    if root and not build.problems():
        (build.folder.path / root.output).unlink(missing_ok=True)  # it may be of another revision
        build.run_missing([root])
    return build.problems()


def plan_exports(build: CityBuild, manifest: dict[str, Any], form: str) -> tuple[pathlib.Path, list[Job]]:
    """Writes the jobs of export_city() for another engine.

    @return the file, and the jobs in an order in which they can run
    """
    parts, root = _jobs(build, manifest, form)
    jobs = [*parts, *([root] if root else [])]
    file = build.folder.path / export_jobs_file(form)
    write_json({**json_of_jobs(build.folder, build.options.version, jobs), "revision": manifest["revision"]}, file)
    return file, jobs


def _jobs(build: CityBuild, manifest: dict[str, Any], form: str) -> tuple[list[Job], Job | None]:
    """A job for each tile, and that of the root if the format has one. Makes their folder."""
    (build.folder.path / export_folder(form)).mkdir(parents=True, exist_ok=True)
    parts = [build.maker.export(tile["file"], form) for tile in manifest["tiles"]]
    return parts, build.maker.export_root(parts) if form == "3dtiles" else None
