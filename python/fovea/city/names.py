"""Names of outputs: hashes of the inputs of the jobs that make them. All are computed before a job runs."""
from __future__ import annotations

import hashlib
import json
import os
import pathlib
import tomllib

from .problems import input_error

_DIGITS = 20  # of a name
NAME_PATTERN = rf"[0-9a-f]{{{_DIGITS}}}"  # of a name, as a regular expression
_MOST_LEVELS = 8  # of calibrated drives, one above the other


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
    """The digest of a drive's name, and of the names, sizes and times of its files. It does not read their content.

    The files of the drives that a calibrated drive corrects belong to it.
    """
    if not drive.is_dir():
        raise input_error("the drive does not exist", drive, "give the folder of a drive (docs/drives.md)")
    try:
        os.path.abspath(drive).encode()
    except UnicodeEncodeError as error:
        raise input_error("the path of the drive is not UTF-8", ascii(str(drive)), "rename the folder") from error
    content: list[object] = [drive.name, *_entries(drive)]
    seen = {os.path.realpath(drive)}
    for _ in range(_MOST_LEVELS):
        corrected = _corrected_drive(drive)
        if corrected is None or os.path.realpath(corrected) in seen:
            break
        drive = corrected
        seen.add(os.path.realpath(drive))
        content.append([drive.name, *_entries(drive)])
    return hashlib.sha256(json.dumps(content).encode()).hexdigest()


def _corrected_drive(drive: pathlib.Path) -> pathlib.Path | None:
    """The folder that a calibrated drive names (docs/drives.md). None for any other drive, or without this folder."""
    try:
        named = tomllib.loads((drive / "drive.toml").read_text(encoding="utf-8"))["calibrated"]["drive"]
        corrected = pathlib.Path(os.path.realpath(drive / named))
    except (OSError, ValueError, LookupError, TypeError):
        return None  # `fovea catalog` reports a damaged file
    return corrected if corrected.is_dir() else None


def _entries(drive: pathlib.Path) -> list[tuple[str, int, int]]:
    """Names, sizes and times of the files of a drive."""
    entries = []
    for file, name in _files(drive):
        status = file.stat()
        entries.append((name, status.st_size, status.st_mtime_ns))
    return sorted(entries)


def _files(drive: pathlib.Path) -> list[tuple[pathlib.Path, str]]:
    """The files of a drive and their names from its folder, with those of KITTI that lie outside the folder."""
    files = []
    visited = {os.path.realpath(drive)}
    for folder, folders, names in os.walk(drive, followlinks=True):
        folders[:] = [name for name in sorted(folders) if _visit(os.path.join(folder, name), visited)]
        for name in names:
            file = pathlib.Path(folder, name)
            if file.exists():  # not a broken link
                files.append((file, str(file.relative_to(drive))))
    resolved = drive.resolve()
    outside = list(resolved.parent.glob("calib_*.txt"))  # of KITTI raw
    if resolved.parent.name == "sequences":  # KITTI odometry
        outside += resolved.parent.parent.glob(f"poses/{resolved.name}.txt")
    return files + [(file, os.path.relpath(file, resolved)) for file in outside]


def _visit(folder: str, visited: set[str]) -> bool:
    """Adds a folder. Returns whether it is new: links may form a circle."""
    real = os.path.realpath(folder)
    if real in visited:
        return False
    visited.add(real)
    return True
