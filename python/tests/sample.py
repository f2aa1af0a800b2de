"""A small simulated drive and a map of it, made once for all tests; one frame has no scan."""
import atexit
import functools
import os
import pathlib
import subprocess
import tempfile

import numpy as np

PROGRAM = os.environ["FOVEA_PROGRAM"]
FRAMES = 6
HELD_OUT = 2
WITHOUT_SCAN = 4
USED = [index for index in range(FRAMES) if index != WITHOUT_SCAN]
SETTINGS = {"surface.spacing_m": 0.1}  # of the map, for speed
HOLD_OUT = f"{FRAMES}:{HELD_OUT}"


@functools.lru_cache(maxsize=None)
def folder() -> pathlib.Path:
    made = tempfile.TemporaryDirectory(prefix="fovea_python_")
    atexit.register(made.cleanup)
    return pathlib.Path(made.name)


def run(*arguments) -> str:
    """What the program says; an error if it fails."""
    return subprocess.run([PROGRAM, *map(str, arguments)], check=True, text=True,
                          stdout=subprocess.PIPE).stdout


@functools.lru_cache(maxsize=None)
def drive() -> pathlib.Path:
    simulated = folder() / "drive"
    run("simulate", "-o", simulated, "--frames", FRAMES, "--quiet")
    scans = sorted(simulated.glob("*/*/velodyne_points/data/*.bin"))
    scans[WITHOUT_SCAN].unlink()
    return simulated


@functools.lru_cache(maxsize=None)
def map_file() -> pathlib.Path:
    """As the program makes it."""
    output = folder() / "program.fovea"
    settings = [word for key, value in SETTINGS.items() for word in ("--set", f"{key}={value}")]
    run("map", drive(), "-o", output, "--quiet", "--hold-out", HOLD_OUT, *settings)
    return output


def open_files() -> set:
    """Names of the files that this process has open."""
    links = pathlib.Path("/proc/self/fd").iterdir()
    return {os.readlink(link) for link in links if link.is_symlink()}


def expect_same_points(points, table) -> None:
    """AssertionError unless the columns are the fields of a table; unknown numbers are equal."""
    for name in table.dtype.names:
        np.testing.assert_array_equal(getattr(points, name), table[name], name)
