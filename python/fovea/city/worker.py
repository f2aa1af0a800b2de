"""Runs one job on a worker of Dask."""
from __future__ import annotations

import os
import shutil
import signal
import socket
import subprocess
import threading
import time
from typing import IO, Any

from .dask_module import dask_module

_STOP_S = 5.0  # a stopped program has this time to remove its unfinished files
_running: dict[str, set[subprocess.Popen[bytes]]] = {}  # by the token of the build
_versions: dict[str, str] = {}  # by the path of the program
_guard = threading.Lock()


class JobError(Exception):
    """A job has failed: its id, the reason in one line, and the address of the worker."""

    def __init__(self, job: str, reason: str, worker: str) -> None:
        super().__init__(job, reason, worker)
        self.job, self.reason, self.worker = job, reason, worker


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
                                  f"the plan was made with {job['version']}", worker)
    began = time.monotonic()
    try:
        with open(job["log"], "wb") as log:
            _write(log, f"# {socket.gethostname()}, {time.strftime('%Y-%m-%d %H:%M:%S')}")
            _write(log, "# " + job["shell"])
            code = _run(job["command"], log, token)
            _write(log, f"# exit code {code} after {time.monotonic() - began:.1f} s")
    except OSError as error:
        raise JobError(job["id"], f"{error.strerror}: {error.filename or job['log']}", worker) from error
    if code < 0:
        raise JobError(job["id"], f"ended by signal {-code}", worker)
    if code != 0:
        raise JobError(job["id"], error_line(job["log"]), worker)
    if not os.path.exists(job["output"]):
        raise JobError(job["id"], f"the command made no {job['output']}", worker)
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


def stop_jobs(token: str) -> None:
    """Ends the running jobs of a build on this worker."""
    with _guard:
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
    process = subprocess.Popen([*with_parent, *command], stdin=subprocess.DEVNULL, stdout=log,
                               stderr=subprocess.STDOUT, start_new_session=True)
    with _guard:
        _running.setdefault(token, set()).add(process)
    try:
        return process.wait()
    finally:
        with _guard:
            _running[token].discard(process)


def _write(log: IO[bytes], line: str) -> None:
    log.write(line.encode() + b"\n")
    log.flush()


def _address() -> str:
    """Of the worker; the host where there is no Dask."""
    try:
        return str(dask_module().get_worker().address)
    except ValueError:
        return socket.gethostname()
