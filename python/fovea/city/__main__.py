"""python3 -m fovea.city"""
from __future__ import annotations

import argparse
import dataclasses
import os
import pathlib
import signal
import sys
from collections.abc import Sequence
from types import FrameType
from typing import Any

from ..errors import Error
from . import build as commands
from .arguments import parser, run_options_of, settings_of
from .clean import clean
from .exports import export_city, plan_exports
from .folder import CityFolder, read_json, write_json
from .jobs import Job, export_folder
from .lock import CityLock
from .manifest import city_of, read_jobs, read_manifest, write_manifest
from .problems import input_error
from .progress import duration, size_text
from .status import status_lines


class Interrupted(BaseException):
    """A signal has ended the command."""

    def __init__(self, number: int) -> None:
        super().__init__(number)
        self.number = number


def main(words: list[str] | None = None) -> int:
    """Runs a command. Returns the exit code."""
    arguments = parser().parse_args(words)
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, _interrupt)
    try:
        return _COMMANDS[arguments.command](arguments)
    except Error as error:
        print(f"fovea.city: error: {error}", file=sys.stderr)
        return 1
    except Interrupted as signaled:
        print("fovea.city: interrupted: run the command again, and it does what is missing", file=sys.stderr)
        return 128 + signaled.number
    except BrokenPipeError:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return 0


def _interrupt(number: int, _: FrameType | None) -> None:
    for each in (signal.SIGINT, signal.SIGTERM):
        signal.signal(each, signal.SIG_IGN)  # while the jobs end
    raise Interrupted(number)


def _plan(arguments: argparse.Namespace) -> int:
    with _build_of(arguments) as build:
        plan = commands.plan(build, arguments.drives)
        failed = build.problems()
    _say_plan(arguments, build.folder.jobs, plan.jobs, ("map", "pair", "poses", "tile", "root"))
    return _report(failed)


def _build(arguments: argparse.Namespace) -> int:
    with _build_of(arguments) as build:
        outcome = commands.build_city(build, arguments.drives)
    return _end(arguments, build, outcome)


def _add(arguments: argparse.Namespace) -> int:
    build, manifest = _build_of_city(arguments)
    with build:
        outcome = commands.add_drives(build, manifest, arguments.drives)
    return _end(arguments, build, outcome)


def _remove(arguments: argparse.Namespace) -> int:
    build, manifest = _build_of_city(arguments)
    with build:
        outcome = commands.remove_drives(build, manifest, arguments.names)
    return _end(arguments, build, outcome)


def _export(arguments: argparse.Namespace) -> int:
    build, manifest = _build_of_city(arguments)
    if arguments.plan:
        with build:
            file, jobs = plan_exports(build, manifest, arguments.format)
        _say_plan(arguments, file, jobs, list(dict.fromkeys(job.kind for job in jobs)))
        return 0
    with build:
        failed = export_city(build, manifest, arguments.format)
    _say(arguments, f"{build.folder.path / export_folder(arguments.format)}: {len(manifest['tiles'])} tiles")
    return _report(failed)


def _status(arguments: argparse.Namespace) -> int:
    folder = CityFolder(arguments.city)
    folder.require()
    print("\n".join(status_lines(folder)))
    return 0


def _clean(arguments: argparse.Namespace) -> int:
    folder = CityFolder(arguments.city)
    folder.require()
    with CityLock(folder) as lock:
        for line in lock.warnings:
            print(f"fovea.city: warning: {line}", file=sys.stderr)
        cleaned = clean(folder, arguments.keep, arguments.dry_run)
    print(f"{folder.path}: {cleaned.files} files, {size_text(cleaned.bytes)} "
          f"{'would be ' if arguments.dry_run else ''}freed; kept: revision {', '.join(map(str, cleaned.kept))}"
          + (f"; unknown files that stay: {cleaned.unknown}" if cleaned.unknown else ""))
    return 0


def _root(arguments: argparse.Namespace) -> int:
    folder = CityFolder(arguments.city)
    folder.require()
    with CityLock(folder):
        listed = read_jobs(folder)
        manifest = write_manifest(folder, listed.tiles, listed.city)
    print(_summary(folder, manifest))
    missing = [file for file in listed.tiles.values() if not folder.has(file)]
    return _report([f"{len(missing)} tiles are missing, as {missing[0]}: see `status`"] if missing else [])


def _keep_poses(arguments: argparse.Namespace) -> int:
    old = pathlib.Path(arguments.old)
    content = read_json(old, "the file of poses", "fovea_poses", 1, "remove the file, and run build again")
    try:
        content["maps"] = [content["maps"][int(number)] for number in arguments.maps.split(",")]
    except (LookupError, TypeError, ValueError) as error:
        raise input_error("the file of poses has other maps", old, "plan again") from error
    write_json(content, pathlib.Path(arguments.new))
    return 0


_COMMANDS = {"plan": _plan, "build": _build, "add": _add, "remove": _remove, "export": _export,
             "clean": _clean, "status": _status, "root": _root, "keep-poses": _keep_poses}


def _build_of(arguments: argparse.Namespace) -> commands.CityBuild:
    settings, options = settings_of(arguments), run_options_of(arguments)
    folder = CityFolder(arguments.output)
    read_manifest(folder)  # of this version
    folder.make()
    return commands.CityBuild(folder, settings, options)


def _build_of_city(arguments: argparse.Namespace) -> tuple[commands.CityBuild, dict[str, Any]]:
    options = run_options_of(arguments)
    folder = CityFolder(arguments.city)
    folder.require()
    manifest = read_manifest(folder)
    if manifest is None:
        raise input_error("the city has no manifest yet", folder.path, "finish build first")
    settings = city_of(manifest, folder).settings
    if getattr(arguments, "control", None):
        settings = dataclasses.replace(settings, control=os.path.abspath(arguments.control))
    return commands.CityBuild(folder, settings, options), manifest


def _end(arguments: argparse.Namespace, build: commands.CityBuild, outcome: commands.Outcome) -> int:
    if outcome.manifest is not None:
        if outcome.jobs_run == 0 and not outcome.problems:
            _say(arguments, "everything is done")
        _say(arguments, _summary(build.folder, outcome.manifest))
    return _report(outcome.problems)


def _summary(folder: CityFolder, manifest: dict[str, Any]) -> str:
    length = sum(drive["length_m"] for drive in manifest["drives"])
    points = sum(tile["points"] for tile in manifest["tiles"])
    return (f"{folder.path}: {len(manifest['drives'])} drives, {length / 1000:.1f} km, {len(manifest['tiles'])} tiles, "
            f"{points / 1e6:.1f} million points, revision {manifest['revision']}")


def _say_plan(arguments: argparse.Namespace, file: pathlib.Path, jobs: Sequence[Job], kinds: Sequence[str]) -> None:
    counts = ", ".join(f"{sum(job.kind == kind for job in jobs)} {kind}" for kind in kinds)
    _say(arguments, f"{file}: {len(jobs)} jobs ({counts}), about {duration(sum(job.expected_s for job in jobs))} "
         "on one core")


def _say(arguments: argparse.Namespace, line: str) -> None:
    if not arguments.quiet:
        print(line, flush=True)


def _report(problems: list[str]) -> int:
    for line in problems:
        print(f"fovea.city: error: {line}", file=sys.stderr)
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
