"""A small simulated drive and its map, which all test modules share."""
import atexit
import functools
import os
import pathlib
import shutil
import subprocess
import tempfile
from typing import Any

import fovea
import numpy as np
import numpy.typing as npt
from scipy.spatial import cKDTree

import recording

PROGRAM = os.environ["FOVEA_PROGRAM"]
FRAMES = 20
SETTINGS = ("camera.numbers=[0]", "camera.width=480", "camera.height=160", "camera.focal=270",
            "camera.cx=238.5", "camera.cy=72.25", "lidar.columns=900")
MILLIMETER = 1e-3


def share(folder: str) -> None:
    """The modules that this process starts keep their sample in this folder."""
    os.environ["FOVEA_INTEROP_SAMPLE"] = folder


@functools.lru_cache(maxsize=None)
def folder() -> pathlib.Path:
    if "FOVEA_INTEROP_SAMPLE" in os.environ:
        return pathlib.Path(os.environ["FOVEA_INTEROP_SAMPLE"])
    made = tempfile.TemporaryDirectory(prefix="fovea_interop_")
    atexit.register(made.cleanup)
    return pathlib.Path(made.name)


def run(*arguments: object) -> str:
    """The output of the program; an error if it fails."""
    return subprocess.run([PROGRAM, *map(str, arguments)], check=True, text=True,
                          stdout=subprocess.PIPE).stdout


def drive() -> pathlib.Path:
    """A folder with a drive.toml."""
    path = folder() / "drive"
    if not path.exists():
        settings = [word for setting in SETTINGS for word in ("--set", setting)]
        run("simulate", "-o", path, "--format", "generic", "--frames", FRAMES, "--seed", 3, "--quiet",
            *settings)
    return path


def map_file() -> pathlib.Path:
    path = folder() / "map.fovea"
    if not path.exists():
        run("map", drive(), "-o", path, "--cameras", 0, "--set", "surface.spacing_m=0.05", "--quiet")
    return path


def recorded_drive() -> pathlib.Path:
    """The sample with poses, in a folder of the same name: a map's digest includes the name of its drive."""
    path = folder() / "recorded" / "drive"
    if not path.exists():
        shutil.copytree(drive(), path)
        recording.write_poses(path)
    return path


@functools.lru_cache(maxsize=None)
def digest(path: pathlib.Path) -> str:
    """That of the map of a drive."""
    output = path.parent / "map.fovea"
    run("map", path, "-o", output, "--cameras", 0, "--quiet", "--force")
    return run("info", "--digest", output)


def export(name: str, *options: str) -> pathlib.Path:
    """An export of the map, by default in the exposure of `fovea.Points`."""
    path = folder() / name
    run("export", map_file(), path, "--force", "--quiet", *options)
    return path


def positions(points: fovea.Points) -> npt.NDArray[np.float64]:
    """N x 3, frame `local` (m)."""
    return points.origin + points.position.astype(np.float64)


def assert_contained(few: list[npt.NDArray[Any]], many: list[npt.NDArray[Any]],
                     tolerance: float = MILLIMETER) -> None:
    """Each of the few points is one of the many. Each list has positions and further columns.

    A point with its further columns is one vector: a wrong column is as far away as a wrong position.
    """
    few_joined, many_joined = (np.column_stack(columns).astype(np.float64) for columns in (few, many))
    distances, _ = cKDTree(many_joined).query(few_joined, distance_upper_bound=2 * tolerance)
    lonely = int(np.sum(~(distances <= tolerance)))
    assert lonely == 0, f"{lonely} of {len(few_joined)} points have no equal one"


def assert_same_points(ours: list[npt.NDArray[Any]], theirs: list[npt.NDArray[Any]],
                       tolerance: float = MILLIMETER) -> None:
    """The points are the same, in any order, see assert_contained()."""
    assert len(ours[0]) == len(theirs[0]), f"{len(ours[0])} and {len(theirs[0])} points"
    assert_contained(ours, theirs, tolerance)
    assert_contained(theirs, ours, tolerance)
