"""The lock of a city: one build at a time."""
from __future__ import annotations

import contextlib
import json
import os
import socket
import time
from types import TracebackType
from typing import Any

from .folder import CityFolder
from .problems import output_error


class CityLock:
    """Holds CITY/lock, a file with the host, the process and its start. A context manager.

    `warnings` states that the lock of a dead process was replaced. OutputError if another build holds it.
    """

    def __init__(self, folder: CityFolder) -> None:
        self._file = folder.lock
        self.warnings: list[str] = []

    def __enter__(self) -> CityLock:
        if self._create():
            return self
        holder = read_lock(self._file)
        if holder is None or not is_dead(holder):
            raise self._busy(holder)
        if not self._remove_stale(holder) or not self._create():
            raise self._busy(read_lock(self._file))
        self.warnings.append(f"the lock of a build that has ended is replaced (process {holder['pid']})")
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None,
                 trace: TracebackType | None) -> None:
        if read_lock(self._file) == self._own:
            self._file.unlink(missing_ok=True)

    def _create(self) -> bool:
        pid = os.getpid()
        self._own: dict[str, Any] = {"host": socket.gethostname(), "pid": pid, "process_start": process_start(pid),
                                     "start": time.strftime("%Y-%m-%d %H:%M:%S")}
        is_made = False
        try:
            with open(self._file, "x", encoding="utf-8") as output:
                is_made = True
                json.dump(self._own, output)
        except FileExistsError:
            return False
        except OSError as error:
            if is_made:
                self._file.unlink(missing_ok=True)
            raise output_error(f"the lock cannot be made ({error.strerror})", self._file,
                               "give a folder that you can write to") from error
        return True

    def _remove_stale(self, holder: dict[str, Any]) -> bool:
        """Moves the lock aside. If it is another one by now, it goes back."""
        aside = self._file.with_name(f"lock.{os.getpid()}.partial")
        try:
            os.rename(self._file, aside)
        except FileNotFoundError:
            return True
        except OSError as error:
            raise output_error(f"the lock of a build that has ended cannot be replaced ({error.strerror})", self._file,
                               "give a folder that you can write to") from error
        is_stale = read_lock(aside) == holder
        try:
            if not is_stale:
                os.link(aside, self._file)
        except FileExistsError:
            pass  # a third build has the lock by now
        except OSError:  # the file system has no hard links
            with contextlib.suppress(FileNotFoundError):
                os.rename(aside, self._file)
        aside.unlink(missing_ok=True)
        return is_stale

    def _busy(self, holder: dict[str, Any] | None) -> Exception:
        if holder is None:
            return output_error("another build has the city", self._file, "wait, or remove the file if none runs")
        who = f"process {holder['pid']} on {holder['host']} since {holder['start']}"
        remedy = "wait until it ends"
        if holder["host"] != socket.gethostname():
            remedy += ", or remove the file if no such process runs there"
        return output_error(f"another build has the city ({who})", self._file, remedy)


def read_lock(file: os.PathLike[str]) -> dict[str, Any] | None:
    """The holder of a lock: host, pid, process_start, start. None if there is no such file or it is not whole."""
    try:
        with open(file, encoding="utf-8") as content:
            holder = json.load(content)
    except (OSError, ValueError):
        return None
    if not isinstance(holder, dict) or not {"host", "pid", "process_start", "start"} <= holder.keys():
        return None
    return holder


def process_start(pid: int) -> str:
    """When a process of this machine started, in ticks since the machine did; "" if there is none."""
    try:
        with open(f"/proc/{pid}/stat", encoding="utf-8", errors="replace") as status:
            return status.read().rsplit(")", 1)[1].split()[19]
    except (OSError, IndexError):
        return ""


def is_dead(holder: dict[str, Any]) -> bool:
    """Of this machine and ended. Another process may have its number by now."""
    return bool(holder["host"] == socket.gethostname() and process_start(holder["pid"]) != holder["process_start"])
