"""Runs `python3 -m fovea.city` with the program of city_fake.py, or another one, in a folder of its own."""
import atexit
import functools
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import time
import unittest

import psutil

import city_fake
from fovea.city.dask_module import dask_module

FAKE = pathlib.Path(city_fake.__file__)
CROSSING = {"a": [(0, 0), (150, 0)], "b": [(70, -70), (70, 70)], "c": [(10, -70), (10, 70), (150, 70)]}
FAR = {"far": [(0, 2000), (80, 2000)]}


@functools.lru_cache(maxsize=None)
def scheduler():
    """The address of a scheduler with one worker, both in this process: they start fast."""
    cluster = dask_module().LocalCluster(
        n_workers=1, threads_per_worker=1, processes=False, protocol="tcp", host="127.0.0.1",
        dashboard_address="127.0.0.1:0", resources={"fovea": 1}, memory_limit=0,
        local_directory=tempfile.gettempdir(), silence_logs=50)
    atexit.register(cluster.close)
    return cluster.scheduler_address


class CityTestCase(unittest.TestCase):
    program = FAKE

    def setUp(self):
        made = tempfile.TemporaryDirectory(prefix="fovea_city_test_")
        self.addCleanup(made.cleanup)
        self.folder = pathlib.Path(made.name)
        self.city = self.folder / "city"
        self.scratch = self.folder / "scratch"
        self.scratch.mkdir()

    def drives(self, **paths):
        """Writes drives of the fake program."""
        return [city_fake.write_drive(self.folder / name, points) for name, points in (paths or CROSSING).items()]

    def start(self, command, *words, **environment):
        """Starts a command, on scheduler() if it does not choose. The environment is that of an embedded cluster."""
        environment = {**os.environ, "FOVEA_PROGRAM": str(self.program), "PYTHONDONTWRITEBYTECODE": "1",
                       **{key: str(value) for key, value in environment.items()}}
        run = ["--scratch", self.scratch] if command in ("plan", "build", "add", "remove") else []
        if command in ("plan", "build") and "--tile-size" not in words:
            run += ["--tile-size", 200]  # few jobs
        if run and not {"--workers", "--scheduler"} & set(words):
            run += ["--scheduler", scheduler()]
        return subprocess.Popen([sys.executable, "-m", "fovea.city", command, *map(str, [*words, *run])],
                                env=environment, text=True, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                                start_new_session=True)

    def end(self, process, code=0):
        """Waits for a command. Returns its stdout and stderr."""
        out, err = process.communicate(timeout=120)
        self.assertEqual(process.returncode, code, out + err)
        self.assertNotIn("Traceback", err)
        return out, err

    def run_city(self, command, *words, code=0, **environment):
        """Runs a command. Returns its stdout and stderr."""
        return self.end(self.start(command, *words, **environment), code)

    def build(self, *words, code=0, **environment):
        """Runs build, on an embedded cluster with one worker if the environment matters."""
        workers = ["--workers", 1] if environment else []
        return self.run_city("build", *words, "-o", self.city, *workers, code=code, **environment)

    def refuse(self, command, *words, **environment):
        """Runs a command that fails before any job. Returns its one line."""
        out, err = self.run_city(command, *words, code=1, **environment)
        self.assertEqual(out, "")
        self.assertEqual(err.count("\n"), 1, err)
        self.assertTrue(err.startswith("fovea.city: error: "), err)
        return err

    def manifest(self):
        """The newest one."""
        return json.loads((self.city / "city.json").read_text())

    def tiles(self):
        """Files of the tiles of the newest manifest."""
        return {tile["file"] for tile in self.manifest()["tiles"]}

    def contents(self):
        """What the fake tiles contain."""
        return {file: city_fake.read_map(self.city / file) for file in self.tiles()}

    def outputs(self):
        """All files of the jobs, and when they were written."""
        return {file: file.stat().st_mtime_ns for name in ("catalog", "maps", "pairs", "poses", "tiles")
                for file in (self.city / name).iterdir()}

    def assert_clean(self):
        """No lock, no partial file, no scratch file is left."""
        self.assertFalse((self.city / "lock").exists())
        self.assertEqual(list(self.city.rglob("*.partial*")), [])
        self.assertEqual(list(self.scratch.iterdir()), [])

    def wait_for_job(self, build):
        """Waits until the program runs below a build. Returns its process."""
        deadline = time.monotonic() + 60
        while time.monotonic() < deadline and build.poll() is None:
            for process in psutil.Process(build.pid).children(recursive=True):
                try:
                    words = process.cmdline()
                except psutil.Error:
                    continue
                if any(word in words for word in ("map", "fuse")) and "-o" in words:
                    return process
            time.sleep(0.01)
        self.fail("no job has begun: " + "".join(build.communicate()) if build.poll() is not None else "in time")
