"""What a build prints: a bar on a terminal, lines elsewhere."""
from __future__ import annotations

import sys
import time

from .jobs import STAGES, Job

_WIDTH = 24  # of the bar, characters
_NAMES = {"catalog": ("drive listed", "drives listed"), "map": ("map", "maps"), "pair": ("pair", "pairs"),
          "poses": ("file of poses", "files of poses"), "tile": ("tile", "tiles"), "root": ("manifest", "manifests"),
          "export": ("tile exported", "tiles exported"), "export root": ("root", "roots")}


class Progress:
    """Counts jobs, points and time. It prints to stderr, and nothing if quiet."""

    def __init__(self, quiet: bool, workers: int) -> None:
        self._quiet, self._is_terminal = quiet, sys.stderr.isatty()
        self._workers = workers
        self._todo: dict[str, float] = {}  # expected seconds by the id of the job
        self._done, self._done_s, self._points = 0, 0.0, 0
        self._began: float | None = None
        self._stage: dict[str, int] = {}  # jobs done by kind, of this stage
        self._stage_began = 0.0

    def expect(self, jobs: list[Job]) -> None:
        """Replaces the jobs that are still to do."""
        self._todo = {job.id: job.expected_s for job in jobs}

    def begin_stage(self) -> None:
        """The next jobs begin."""
        self._stage, self._stage_began = {}, time.monotonic()
        self._began = self._began or self._stage_began
        self.show()

    def job_done(self, job: Job, points: int = 0) -> None:
        """A job has ended well; `points` are those of its tile."""
        self._done += 1
        self._done_s += self._todo.pop(job.id, 0.0)
        self._points += points
        self._stage[job.kind] = self._stage.get(job.kind, 0) + 1
        self.show()

    def end_stage(self) -> None:
        """The jobs of a stage have ended, well or not. Prints a line for it."""
        self._clear()
        counts = [f"{self._stage[kind]} {_NAMES[kind][self._stage[kind] > 1]}" for kind in STAGES
                  if kind in self._stage]
        if counts and not self._is_terminal:
            self._print(f"{', '.join(counts)}: {duration(time.monotonic() - self._stage_began)}")

    def show(self) -> None:
        """Draws the bar."""
        if self._quiet or not self._is_terminal or self._began is None:
            return
        total = self._done + len(self._todo)
        filled = _WIDTH * self._done // max(total, 1)
        points = f", {self._points / 1e6:.1f} million points" if self._points else ""
        sys.stderr.write(f"\r\x1b[K[{'#' * filled}{' ' * (_WIDTH - filled)}] {self._done}/{total} jobs{points}"
                         f"{self._time_left()}")
        sys.stderr.flush()

    def say(self, line: str) -> None:
        """Prints a line, of a warning."""
        self._clear()
        self._print(line)
        self.show()

    def _time_left(self) -> str:
        left_s = sum(self._todo.values())
        elapsed = time.monotonic() - (self._began or 0.0)
        if not self._todo or self._began is None:
            return ""
        rate = self._done_s / elapsed if self._done_s > 0 and elapsed > 5 else float(self._workers)
        return f", {duration(left_s / rate)} left"

    def _clear(self) -> None:
        if not self._quiet and self._is_terminal:
            sys.stderr.write("\r\x1b[K")
            sys.stderr.flush()

    def _print(self, line: str) -> None:
        if not self._quiet:
            print(line, file=sys.stderr, flush=True)


def duration(seconds: float) -> str:
    """For people: 12 s, 5 min, 3.5 h."""
    if seconds < 100:
        return f"{seconds:.0f} s"
    return f"{seconds / 60:.0f} min" if seconds < 6000 else f"{seconds / 3600:.1f} h"


def size_text(count: float) -> str:
    """Of bytes, for people: 0.4 MB, 2.1 GB."""
    return f"{count / 1e9:.1f} GB" if count >= 1e9 else f"{count / 1e6:.1f} MB"
