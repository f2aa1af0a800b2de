"""Names of outputs: hashes of the inputs of the jobs that make them. All are computed before a job runs."""
from __future__ import annotations

import hashlib
import json
import os
import pathlib

from .problems import input_error

_DIGITS = 20  # of a name


def name_of(kind: str, *inputs: object) -> str:
    """The name of the output of a job of this kind with these inputs: text, numbers, and lists of them."""
    text = json.dumps([kind, *inputs], ensure_ascii=True, separators=(",", ":"))
    return hashlib.sha256(text.encode()).hexdigest()[:_DIGITS]


def content_digest(path: pathlib.Path | None) -> str:
    """The digest of the content of a file, "" for no file."""
    if path is None:
        return ""
    try:
        return hashlib.sha256(path.read_bytes()).hexdigest()
    except OSError as error:
        raise input_error(f"the file cannot be read ({error.strerror})", path, "give a file that exists") from error


def drive_digest(drive: pathlib.Path) -> str:
    """The digest of a drive's name, and of the names, sizes and times of its files. It does not read their content."""
    if not drive.is_dir():
        raise input_error("the drive does not exist", drive, "give the folder of a drive (docs/drives.md)")
    entries = []
    for file, name in _files(drive):
        status = file.stat()
        entries.append((name, status.st_size, status.st_mtime_ns))
    return hashlib.sha256(json.dumps([drive.name, *sorted(entries)]).encode()).hexdigest()


def _files(drive: pathlib.Path) -> list[tuple[pathlib.Path, str]]:
    """The files of a drive and their names from its folder, with those of KITTI that lie outside the folder."""
    files = []
    for folder, _, names in os.walk(drive):
        for name in names:
            file = pathlib.Path(folder, name)
            if file.exists():  # not a broken link
                files.append((file, str(file.relative_to(drive))))
    resolved = drive.resolve()
    outside = list(resolved.parent.glob("calib_*.txt"))  # of KITTI raw
    if resolved.parent.name == "sequences":  # KITTI odometry
        outside += resolved.parent.parent.glob(f"poses/{resolved.name}.txt")
    return files + [(file, os.path.relpath(file, resolved)) for file in outside]
