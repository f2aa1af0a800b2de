"""Runs one job on a worker of Dask."""
from __future__ import annotations

import contextlib
import os
import re
import shutil
import signal
import socket
import subprocess
import threading
import time
from collections.abc import Sequence
from typing import IO, Any

from .dask_module import dask_module

_STOP_S = 5.0  # a stopped program has this time to remove its unfinished files
_MACHINE_FAILED = 74  # exit code of `fovea` (docs/command-line.md): a full disk, as an example
_SIGNALED = 128  # exit code of a program that a signal ended, less the signal
_running: dict[str, set[subprocess.Popen[bytes]]] = {}  # by the token of the build
_stopped: set[str] = set()  # tokens of builds whose jobs must not begin
_versions: dict[str, str] = {}  # by the path of the program
_guard = threading.Lock()


class JobError(Exception):
    """A job has failed: its id, the reason in one line, and the address of the worker.

    `of_machine`: the machine is the cause, not the inputs. The job may end well later.
    """

    def __init__(self, job: str, reason: str, worker: str, of_machine: bool = False) -> None:
        super().__init__(job, reason, worker, of_machine)
        self.job, self.reason, self.worker, self.of_machine = job, reason, worker, of_machine


class IgnoreCtrlC:
    """A plugin of workers: Ctrl-C ends the build, which then ends its workers."""

    def setup(self, worker: Any) -> None:  # pylint: disable=unused-argument  # the interface of Dask
        """In the main thread of each worker."""
        signal.signal(signal.SIGINT, signal.SIG_IGN)


def run_job(job: dict[str, Any], token: str, *_after: object) -> str:
    """Runs a job of jobs.json and writes its log. JobError if it fails.

    @param job    has `id`, `command`, `output` and `log` (absolute paths), `program` and `version`
    @param token  of the build, for stop_jobs()
    @param _after results of the jobs before it: Dask waits for them
    """
    worker = _address()
    if os.path.exists(job["output"]):
        return worker
    version = program_version(job["program"])
    if version != job["version"]:
        raise JobError(job["id"], f"{job['program']} is {version or 'missing'} on {socket.gethostname()}, "
                                  f"the plan was made with {job['version']}", worker, of_machine=True)
    remove_scratch_files(job["command"])
    began = time.monotonic()
    try:
        with open(job["log"], "wb") as log:
            _write(log, f"# {socket.gethostname()}, {time.strftime('%Y-%m-%d %H:%M:%S')}")
            _write(log, "# " + job["shell"])
            code = _run(job["command"], log, token)
            _write(log, f"# exit code {code} after {time.monotonic() - began:.1f} s")
    except OSError as error:
        raise JobError(job["id"], f"{error.strerror}: {error.filename or job['log']}", worker,
                       of_machine=True) from error
    number = -code if code < 0 else code - _SIGNALED
    if number > 0:
        raise JobError(job["id"], f"ended by signal {number}", worker, of_machine=True)
    if code != 0:
        raise JobError(job["id"], error_line(job["log"]), worker, of_machine=code == _MACHINE_FAILED)
    if not os.path.exists(job["output"]):
        raise JobError(job["id"], f"the command made no {job['output']}", worker, of_machine=True)
    return worker


def error_line(log: str) -> str:
    """The last line of a program in a log, without "fovea: error: "."""
    try:
        with open(log, encoding="utf-8", errors="replace") as content:
            lines = [line.strip() for line in content if line.strip() and not line.startswith("# ")]
    except OSError:
        lines = []
    errors = [line for line in lines if "error: " in line] or lines or ["it printed no error"]
    return errors[-1].removeprefix("fovea: ").removeprefix("error: ")


def remove_scratch_files(command: Sequence[str]) -> None:
    """Removes the files that killed jobs of this machine left in the scratch folder of a command.

    The program names them NAME.HOST-PROCESS-NUMBER.partial.
    """
    if "--scratch" not in command:
        return
    name = re.compile(rf".+\.{re.escape(socket.gethostname())}-(\d+)-\d+\.partial.*")
    with contextlib.suppress(OSError):  # the program reports a folder that it cannot use
        for entry in os.scandir(command[command.index("--scratch") + 1]):
            match = name.fullmatch(entry.name)
            if match and not os.path.exists(f"/proc/{match[1]}"):
                with contextlib.suppress(OSError):  # of another user, or removed by another worker
                    os.unlink(entry.path)


def stop_jobs(token: str) -> None:
    """Ends the running jobs of a build on this worker. No other job of the build begins here."""
    with _guard:
        _stopped.add(token)
        processes = list(_running.get(token, ()))
    for process in processes:
        process.terminate()
    deadline = time.monotonic() + _STOP_S
    for process in processes:
        while process.poll() is None and time.monotonic() < deadline:
            time.sleep(0.02)
        if process.poll() is None:
            process.kill()


def program_version(program: str) -> str:
    """As `fovea --version` prints it, "" if the program does not run."""
    if program not in _versions:
        try:
            _versions[program] = subprocess.run([program, "--version"], check=True, text=True, stdout=subprocess.PIPE,
                                                stderr=subprocess.DEVNULL).stdout.strip()
        except (OSError, subprocess.CalledProcessError):
            return ""
    return _versions[program]


def _run(command: list[str], log: IO[bytes], token: str) -> int:
    """The exit code; below 0 the signal that ended the program. The program ends if this thread does."""
    setpriv = shutil.which("setpriv")  # of util-linux
    with_parent = [setpriv, "--pdeathsig", "KILL", "--"] if setpriv else []
    with _guard:
        if token in _stopped:
            return -signal.SIGTERM
        process = subprocess.Popen([*with_parent, *command], stdin=subprocess.DEVNULL, stdout=log,
                                   stderr=subprocess.STDOUT, start_new_session=True)
        _running.setdefault(token, set()).add(process)
    try:
        return process.wait()
    finally:
        with _guard:
            _running[token].discard(process)


def _write(log: IO[bytes], line: str) -> None:
    log.write(line.encode(errors="backslashreplace") + b"\n")
    log.flush()


def _address() -> str:
    """Of the worker; the host where there is no Dask."""
    try:
        return str(dask_module().get_worker().address)
    except ValueError:
        return socket.gethostname()
