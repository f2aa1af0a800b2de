"""Runs graphs of jobs on Dask Distributed: an embedded cluster of this machine, or an existing scheduler."""
from __future__ import annotations

import logging
import os
import queue
import shutil
import tempfile
import time
import uuid
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Any

from .dask_module import dask_module
from .folder import CityFolder
from .jobs import Job
from .problems import input_error
from .settings import RunOptions
from .worker import IgnoreCtrlC, JobError, run_job, stop_jobs

RESOURCE = "fovea"  # each job takes one of it, each worker has one
_CONNECT_S = 5.0  # a scheduler has this time to answer
_RECONNECT_S = 60.0  # and this, if it restarts
_MOST_RECONNECTS = 5
_WORKER_WARNING_S = 20.0  # without a worker that can run jobs


@dataclass(frozen=True)
class Failure:
    """A job that has failed, with the reason in one line."""

    job: Job
    reason: str
    of_machine: bool = False  # see JobError


@dataclass
class _Round:
    """A graph of jobs, and what became of it."""

    futures: dict[str, Any] = field(default_factory=dict)
    places: dict[str, set[str]] = field(default_factory=dict)  # the only workers of jobs that are tried again
    failed: dict[str, JobError] = field(default_factory=dict)
    done: set[str] = field(default_factory=set)
    lost: bool = False  # the scheduler has gone


class Runner:
    """Runs jobs. It connects to Dask when the first job runs. A context manager; it ends jobs that still run."""

    def __init__(self, folder: CityFolder, options: RunOptions, warn: Callable[[str], None]) -> None:
        self._folder, self._options, self._warn = folder, options, warn
        self._token = uuid.uuid4().hex[:12]  # of this build: other builds share the scheduler
        self._client: Any = None
        self._cluster: Any = None
        self._local: str | None = None  # folder of the embedded cluster
        self._futures: dict[str, Any] = {}  # of the newest graph
        self._rounds = 0

    def __enter__(self) -> Runner:
        return self

    def __exit__(self, *_: object) -> None:
        self._disconnect(stop=True)

    def run(self, jobs: Sequence[Job], on_done: Callable[[Job], None], on_wait: Callable[[], None]) -> list[Failure]:
        """Runs jobs in the order that their `after` gives. A job that fails is tried again on another worker.

        @param on_done  called after each job that ends well
        @param on_wait  called about once a second
        @return the jobs that failed; jobs after them did not run
        """
        left = {job.id: job for job in jobs}
        failures: list[Failure] = []
        tries: dict[str, int] = {}
        avoid: dict[str, set[str]] = {}  # workers, by the id of a job that failed there
        reconnects = 0
        while left:
            result = self._run_once(list(left.values()), avoid, on_done, on_wait)
            for done in result.done:
                del left[done]
            if result.lost:
                reconnects += 1
                self._reconnect(reconnects)
            for id, error in result.failed.items():
                tries[id] = tries.get(id, 0) + 1
                avoid.setdefault(id, set()).add(error.worker)
                if tries[id] > self._options.retries:
                    failures.append(Failure(left[id], error.reason, error.of_machine))
                    _remove_with_later(left, id)
        return failures

    def _run_once(self, jobs: Sequence[Job], avoid: dict[str, set[str]], on_done: Callable[[Job], None],
                  on_wait: Callable[[], None]) -> _Round:
        """Submits a graph, and waits for all of it."""
        self._connect()
        ended: queue.Queue[tuple[Job, Any]] = queue.Queue()
        graph = self._submit(jobs, avoid, ended)
        waiting, quiet_since = len(jobs), time.monotonic()
        while waiting and not graph.lost:
            try:
                job, future = ended.get(timeout=1.0)
            except queue.Empty:
                on_wait()
                quiet_since = self._watch(graph, quiet_since)
                continue
            waiting -= 1
            if future.status == "finished":
                graph.done.add(job.id)
                on_done(job)
            elif future.status == "error":
                error = _own_error(job, future.exception())
                if error is not None:
                    graph.failed[job.id] = error
            elif self._client.status != "running":  # else _watch() has canceled it: it runs in the next round
                graph.lost = True
        return graph

    def _submit(self, jobs: Sequence[Job], avoid: dict[str, set[str]],
                ended: queue.Queue[tuple[Job, Any]]) -> _Round:
        self._rounds += 1
        graph = _Round()
        self._futures = graph.futures
        workers = self._workers()
        for job in jobs:
            before = [graph.futures[id] for id in job.after if id in graph.futures]
            if job.id in avoid and workers - avoid[job.id]:
                graph.places[job.id] = workers - avoid[job.id]
            future = self._client.submit(
                run_job, self._description(job), self._token, *before, key=f"{job.id}-{self._token}-{self._rounds}",
                resources={RESOURCE: 1}, pure=False, retries=0, workers=sorted(graph.places.get(job.id, ())) or None)
            future.add_done_callback(lambda future, job=job: ended.put((job, future)))
            graph.futures[job.id] = future
        return graph

    def _watch(self, graph: _Round, quiet_since: float) -> float:
        """Finds what Dask does not report. Returns since when no job has ended, or since the last warning."""
        if self._client.status != "running":
            graph.lost = self._client.status in ("closing", "closed")
            return quiet_since
        workers = self._workers()
        for id, place in graph.places.items():
            if place.isdisjoint(workers) and not graph.futures[id].done():
                graph.futures[id].cancel()  # its workers have gone
        if self._options.scheduler is None or time.monotonic() - quiet_since < _WORKER_WARNING_S:
            return quiet_since
        if not workers:
            self._warn(f"no worker of {self._options.scheduler} runs jobs: start workers with "
                       f"`dask worker {self._options.scheduler} --nthreads 1 --resources {RESOURCE}=1`")
        return time.monotonic()

    def _workers(self) -> set[str]:
        """The addresses of the workers that can run jobs."""
        workers = self._client.scheduler_info()["workers"]
        return {address for address, worker in workers.items() if worker.get("resources", {}).get(RESOURCE)}

    def _description(self, job: Job) -> dict[str, Any]:
        return {**job.json(), "output": str(self._folder.path / job.output), "log": str(self._folder.path / job.log),
                "program": self._options.program, "version": self._options.version}

    def _connect(self, timeout_s: float = _CONNECT_S) -> None:
        if self._client is not None:
            return
        distributed = dask_module()
        if self._options.scheduler is not None:
            try:
                self._client = distributed.Client(self._options.scheduler, timeout=timeout_s,
                                                  set_as_default=False)
            except (OSError, ValueError) as error:
                raise input_error(f"there is no scheduler ({error})", self._options.scheduler,
                                  "start one with `dask scheduler`, and run the command again: "
                                  "it does only what is missing") from error
            return
        self._local = tempfile.mkdtemp(prefix="fovea_city_", dir=self._options.scratch)
        self._cluster = distributed.LocalCluster(
            n_workers=worker_count(self._options), threads_per_worker=1, processes=True, host="127.0.0.1",
            dashboard_address="127.0.0.1:0", worker_dashboard_address="127.0.0.1:0", resources={RESOURCE: 1},
            memory_limit=0, local_directory=self._local, silence_logs=logging.CRITICAL)
        self._client = distributed.Client(self._cluster, set_as_default=False)
        self._client.register_worker_plugin(IgnoreCtrlC())

    def _reconnect(self, count: int) -> None:
        if count > _MOST_RECONNECTS or self._options.scheduler is None:
            raise input_error("the scheduler ended during the build", self._options.scheduler or "embedded cluster",
                              "run the command again: it does only what is missing")
        self._warn(f"the connection to {self._options.scheduler} is lost, trying again for {_RECONNECT_S:.0f} s")
        self._disconnect(stop=False)
        self._connect(_RECONNECT_S)

    def _disconnect(self, stop: bool) -> None:
        if self._client is not None:
            try:
                if stop:
                    self._client.cancel(list(self._futures.values()), force=True)  # else the next jobs begin
                    self._client.run(stop_jobs, self._token)
            except Exception:  # pylint: disable=broad-except  # workers or the scheduler are gone
                pass
            self._client.close(timeout=5)
            self._client = None
        if self._cluster is not None:
            self._cluster.close(timeout=10)
            self._cluster = None
        if self._local is not None:
            shutil.rmtree(self._local, ignore_errors=True)
            self._local = None


def worker_count(options: RunOptions) -> int:
    """Of the embedded cluster: as many as the cores and the memory of this machine allow, unless it is given."""
    if options.workers is not None:
        return options.workers
    memory = os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES")
    return max(1, min(len(os.sched_getaffinity(0)) // options.threads, memory // options.memory_bytes))


def _own_error(job: Job, error: BaseException | None) -> JobError | None:
    """The error of this job; None if it did not run because a job before it failed."""
    if isinstance(error, JobError):
        return error if error.job == job.id else None
    task = str(getattr(error, "task", job.id))  # of KilledWorker
    if not task.startswith(job.id):
        return None
    reason = "its workers were killed" if hasattr(error, "task") else f"{type(error).__name__}: {error}"
    return JobError(job.id, reason.splitlines()[0], "", of_machine=True)


def _remove_with_later(left: dict[str, Job], id: str) -> None:
    """Removes a job and all jobs after it."""
    removed = {id}
    del left[id]
    for job in list(left.values()):  # in an order in which they can run
        if not removed.isdisjoint(job.after):
            removed.add(job.id)
            del left[job.id]
