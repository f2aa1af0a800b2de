"""`clean CITY`: deletes the files that no kept revision needs."""
from __future__ import annotations

import os
import pathlib
import re
import shutil
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import Any

from .build import needed_jobs
from .folder import FOLDERS, CityFolder, sync_folder
from .jobs import EXPORT_FORMS, JobMaker, export_folder, export_jobs_file, poses_file
from .manifest import city_of, read_jobs, read_manifest, read_revision
from .names import NAME_PATTERN
from .plan import Request, make_plan
from .problems import input_error, output_error
from .settings import RunOptions

_TILE = rf"-?\d+_-?\d+_({NAME_PATTERN})"
_JSON = rf"({NAME_PATTERN})\.json"
# Files of jobs, by their folder; the group is the name that a hash gives them. No other file is deleted.
_FILES = {
    "catalog": _JSON, "maps": rf"({NAME_PATTERN})\.fovea", "pairs": _JSON, "poses": _JSON,
    "tiles": rf"{_TILE}\.(?:fovea|overview\.glb)",
    "logs": rf"(?:catalog|map|pair|poses|tile|export)-(?:.+[-_])?({NAME_PATTERN})\.log",
    **{export_folder(form): _TILE if form == "3dtiles" else rf"{_TILE}\.{form}" for form in EXPORT_FORMS}}
_KNOWN_FILES = {**_FILES, "manifests": r"[1-9]\d*\.json"}
_TILESET = ("tileset.json", "q")  # in the folder of the export 3dtiles
# Further known files and folders, by their folder.
_OTHERS = {"": {"city.json", "jobs.json", "lock", "exports", *FOLDERS}, "logs": {"root.log", "export-root.log"},
           "exports": {pathlib.PurePath(file(form)).name for form in EXPORT_FORMS
                       for file in (export_folder, export_jobs_file)},
           export_folder("3dtiles"): set(_TILESET)}


@dataclass
class Cleaned:
    """What `clean` deleted, or would delete."""

    kept: list[int]  # revisions
    files: int = 0
    bytes: int = 0
    unknown: int = 0  # files that stay because this package does not make such files


def clean(folder: CityFolder, keep: int, dry_run: bool) -> Cleaned:
    """Deletes the files that only older revisions than the newest `keep` need. Its caller holds the lock."""
    try:
        return _clean(folder, keep, dry_run)
    except OSError as error:
        raise input_error(f"a file of the city cannot be read ({error.strerror})", error.filename or folder.path,
                          "make it readable, and run clean again") from error


def _clean(folder: CityFolder, keep: int, dry_run: bool) -> Cleaned:
    manifests = _kept_manifests(folder, keep)
    names = _names_of_jobs(folder)
    for manifest in manifests.values():
        names |= _names_of_revision(folder, manifest)
    cleaned = Cleaned(sorted(manifests), unknown=_count_unknown(folder))
    old_manifests = [file for number, file in _manifest_files(folder).items() if number not in manifests]
    unneeded = list(_unneeded_files(folder, names))
    for file in (*old_manifests, *unneeded):
        for part in _files_in(file):
            cleaned.files += 1
            cleaned.bytes += part.lstat().st_size
    if not dry_run:
        _remove(old_manifests)
        sync_folder(folder.path / "manifests")  # a manifest never outlives its files, also after a power cut
        _remove(unneeded)
    return cleaned


def _kept_manifests(folder: CityFolder, keep: int) -> dict[int, dict[str, Any]]:
    """By revision. A manifest newer than city.json is of a build that a power cut ended."""
    newest = read_manifest(folder)
    if newest is None:
        raise input_error("the city has no manifest yet", folder.path, "finish build first")
    there = sorted(_manifest_files(folder))
    older = [number for number in there if number < newest["revision"]]
    newer = [number for number in there if number > newest["revision"]]
    numbers = [*older[max(0, len(older) + 1 - keep):], *newer]
    return {newest["revision"]: newest, **{number: read_revision(folder, number) for number in numbers}}


def _manifest_files(folder: CityFolder) -> dict[int, pathlib.Path]:
    return {int(file.stem): file for file in _entries(folder.path / "manifests")
            if re.fullmatch(_KNOWN_FILES["manifests"], file.name)}


def _names_of_jobs(folder: CityFolder) -> set[str]:
    """Names of what the jobs in jobs.json make, and of what those need that have not run: a plan may be under way."""
    if not folder.jobs.exists():
        return set()
    jobs = read_jobs(folder).jobs
    needed = needed_jobs(jobs, folder)
    return _names_in([job.output for job in jobs] + [file for job in needed for file in job.inputs])


def _names_of_revision(folder: CityFolder, manifest: dict[str, Any]) -> set[str]:
    """Names of what a revision needs: also to build it again, and for `add` and `remove`."""
    city = city_of(manifest, folder)
    maker = JobMaker(str(folder.path), city.settings, RunOptions())
    plan = make_plan(Request(city.settings, city.segments, city.fixed()), maker)  # with pairs and empty tiles
    files = [manifest["poses"], poses_file(city.poses), *(tile["file"] for tile in manifest["tiles"]),
             *(job.output for job in plan.jobs)]
    placed_by = {segment.placed_by for segment in city.segments if segment.placed_by}
    return _names_in(files) | placed_by | {segment.drive.catalog_name for segment in city.segments}


def _names_in(files: Iterable[str]) -> set[str]:
    found = (re.search(NAME_PATTERN, os.path.basename(file)) for file in files)
    return {match[0] for match in found if match}


def _unneeded_files(folder: CityFolder, names: set[str]) -> Iterator[pathlib.Path]:
    """Files, and folders of exported tiles. Lists come before the files in them, maps before their overviews."""
    for lists in ([folder.path / export_folder("3dtiles") / name for name in _TILESET],
                  *([folder.path / export_jobs_file(form)] for form in EXPORT_FORMS)):
        there = [file for file in lists if file.exists()]
        if not _names_of_tiles(there) <= names:
            yield from there
    for name, pattern in _FILES.items():
        for file in sorted(_entries(folder.path / name), key=lambda file: (file.suffix == ".glb", file.name)):
            match = re.fullmatch(pattern, file.name)
            if match and match[1] not in names:
                yield file


def _names_of_tiles(lists: Iterable[pathlib.Path]) -> set[str]:
    """Names of the tiles that a tileset or a list of exports refers to."""
    texts = [file.read_text(errors="replace") for file in _all_files(lists) if file.suffix == ".json"]
    return {match[1] for text in texts for match in re.finditer(_TILE, text)}


def _count_unknown(folder: CityFolder) -> int:
    unknown = [file for name in {*_KNOWN_FILES, *_OTHERS} for file in _entries(folder.path / name)
               if file.name not in _OTHERS.get(name, ()) and not re.fullmatch(_KNOWN_FILES.get(name, ""), file.name)]
    return sum(1 for _ in _all_files(unknown))


def _entries(folder: pathlib.Path) -> list[pathlib.Path]:
    """Of a folder that may be missing, without partial files: builds remove those."""
    return [file for file in folder.iterdir() if ".partial" not in file.name] if folder.is_dir() else []


def _all_files(entries: Iterable[pathlib.Path]) -> Iterator[pathlib.Path]:
    for entry in entries:
        yield from _files_in(entry)


def _files_in(entry: pathlib.Path) -> Iterator[pathlib.Path]:
    """The entry itself, or all files in the folder."""
    if entry.is_symlink() or not entry.is_dir():
        yield entry
        return
    for root, _, files in os.walk(entry):
        yield from (pathlib.Path(root, file) for file in files)


def _remove(files: Iterable[pathlib.Path]) -> None:
    for file in files:
        try:
            if file.is_symlink() or not file.is_dir():
                file.unlink(missing_ok=True)
            else:  # a part of a folder must not have its name
                partial = file.with_name(f"{file.name}.{os.getpid()}.partial")
                file.rename(partial)
                shutil.rmtree(partial)
        except OSError as error:
            raise output_error(f"the file cannot be removed ({error.strerror})", error.filename or file,
                               "make its folder writable, and run clean again") from error
