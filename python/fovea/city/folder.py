"""The folder of a city: its files, and JSON files in it that appear whole."""
from __future__ import annotations

import contextlib
import json
import os
import pathlib
import shutil
from typing import Any

from .problems import input_error, output_error

FOLDERS = ("catalog", "maps", "pairs", "poses", "tiles", "manifests", "logs")


class CityFolder:
    """CITY/: the layout is in docs/city.md."""

    def __init__(self, path: str | os.PathLike[str]) -> None:
        self.path = pathlib.Path(os.path.abspath(path))
        self.manifest = self.path / "city.json"
        self.jobs = self.path / "jobs.json"
        self.lock = self.path / "lock"

    def make(self) -> None:
        """Makes the folder. OutputError if the folder of something else is there."""
        if self.path.exists() and not self.is_city() and (not self.path.is_dir() or any(self.path.iterdir())):
            raise output_error("the folder is not a city", self.path, "give another folder, or an empty one")
        try:
            for name in FOLDERS:
                (self.path / name).mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise output_error(f"the folder cannot be made ({error.strerror})", self.path,
                               "give a folder that you can write to") from error

    def require(self) -> None:
        """InputError if the folder is no city."""
        if not self.is_city():
            raise input_error("the folder is not a city", self.path,
                              "give the folder that build or plan has made")

    def is_city(self) -> bool:
        """It has the folders of one: also before the first manifest."""
        return self.manifest.is_file() or all((self.path / name).is_dir() for name in ("catalog", "maps", "tiles"))

    def has(self, file: str) -> bool:
        """A file is there, given relative to the folder or absolute. On NFS it may be new, from another machine."""
        path = self.path / file
        if path.exists():
            return True
        try:
            os.scandir(path.parent).close()  # NFS reads the folder again
        except OSError:
            return False
        return path.exists()

    def remove_partial_files(self, older_than_s: float | None = None) -> None:
        """Removes what killed jobs left; with a limit, only files last written before it (seconds since 1970)."""
        exports = self.path / "exports"
        folders = [*(self.path / name for name in FOLDERS), exports, *exports.glob("*")]
        files = [file for folder in folders for file in folder.glob("*.partial*")]
        for own in (self.manifest, self.jobs, self.lock):
            files += self.path.glob(f"{own.name}.*.partial")
        for file in files:
            try:
                if older_than_s is not None and file.lstat().st_mtime >= older_than_s:
                    continue
                if file.is_dir():
                    shutil.rmtree(file)
                else:
                    file.unlink()
            except FileNotFoundError:
                continue

    def bytes_of(self, name: str) -> int:
        """Of the files in one of FOLDERS."""
        total = 0
        for entry in os.scandir(self.path / name):
            try:
                total += entry.stat().st_size
            except FileNotFoundError:
                continue  # a partial file that has its name now
        return total


def sync_folder(path: pathlib.Path) -> None:
    """Makes durable which files a folder has. Some file systems refuse this: no error then."""
    with contextlib.suppress(OSError):
        descriptor = os.open(path, os.O_RDONLY | os.O_DIRECTORY)
        try:
            os.fsync(descriptor)
        finally:
            os.close(descriptor)


def write_json(content: dict[str, Any], file: pathlib.Path) -> None:
    """Writes a file that appears whole, also for other machines."""
    partial = file.with_name(f"{file.name}.{os.getpid()}.partial")
    try:
        with open(partial, "w", encoding="utf-8") as output:
            json.dump(content, output, indent=1, ensure_ascii=False, allow_nan=False)
            output.write("\n")
            output.flush()
            os.fsync(output.fileno())
        os.replace(partial, file)
    except OSError as error:
        raise output_error(f"the file cannot be written ({error.strerror})", file,
                           "free disk space, or give a folder that you can write to") from error
    except UnicodeEncodeError as error:
        raise output_error(f"the file cannot be written: {error.object!a} is not UTF-8", file,
                           "rename the folder or file") from error
    except ValueError as error:
        raise output_error(f"the file cannot be written ({error})", file, "report this as a fault of Fovea") from error
    finally:
        with contextlib.suppress(OSError):
            partial.unlink(missing_ok=True)


def read_json(file: pathlib.Path, kind: str, version_key: str, version: int, remedy: str) -> dict[str, Any]:
    """Reads a file of this package. InputError if it is missing, damaged or of another version."""
    try:
        content = json.loads(file.read_text(encoding="utf-8"))
    except OSError as error:
        raise input_error(f"{kind} cannot be read ({error.strerror})", file, remedy) from error
    except ValueError as error:
        raise input_error(f"{kind} is damaged", file, remedy) from error
    if not isinstance(content, dict) or version_key not in content:
        raise input_error(f"{kind} is damaged: it has no {version_key}", file, remedy)
    if content[version_key] != version:
        raise input_error(f"{kind} has version {content[version_key]}, this program reads version {version}", file,
                          "use the program that made it, or build the city again in another folder")
    return content
