"""LAZ and COPC files of maps and points, with laspy and copclib (pip install "laspy[lazrs]" copclib).

    fovea.laz.write(fovea.Map("street.fovea"), "street.laz", crs="utm")
    fovea.laz.write("street.fovea", "street.copc.laz")
    fovea.laz.write(points, "part.laz")
"""
from __future__ import annotations

import os
import pathlib
import tempfile
from typing import Any, Dict, Union

import numpy as np
import numpy.typing as npt

from . import _map
from ._extras import load
from .errors import ConfigError, OutputError

__all__ = ["las_columns", "write"]

_Path = Union[str, "os.PathLike[str]"]
_CHUNK = 1_000_000  # points in memory at the same time
_SCALE = 0.001  # m
_EXTRA = {"camera": np.int8, "frame": np.int32, "range": np.float32, "interpolated": np.uint8,
          "views": np.uint8, "spread": np.uint8, "reason": np.uint8}


def las_columns(points: _map.Points) -> Dict[str, npt.NDArray[Any]]:
    """The columns of points by the names of laspy, as `fovea export` writes them into LAS.

    xyz: N x 3, m; red, green, blue: 257 times the 8-bit value; intensity: 0 to 65535.
    """
    color = points.color.astype(np.uint16) * 257
    color[points.camera < 0] = 128 * 257
    intensity = points.intensity
    reflectance = np.zeros(len(points))
    if intensity is not None:
        reflectance = np.clip(np.nan_to_num(intensity.astype(np.float64)), 0, 1)
    columns: Dict[str, npt.NDArray[Any]] = {
        "xyz": points.xyz, "red": color[:, 0], "green": color[:, 1], "blue": color[:, 2],
        "intensity": np.floor(65535 * reflectance + 0.5).astype(np.uint16),
        "synthetic": points.interpolated != 0,
        "classification": np.ones(len(points), np.uint8),
        "return_number": np.ones(len(points), np.uint8),
        "number_of_returns": np.ones(len(points), np.uint8)}
    columns.update({name: getattr(points, name) for name in _EXTRA})
    return columns


def _write_las_of_points(points: _map.Points, las: pathlib.Path) -> None:
    laspy = load("laspy", "laz")
    header = laspy.LasHeader(version="1.4", point_format=7)
    header.scales = np.full(3, _SCALE)
    middle = points.xyz.mean(axis=0) if len(points) else np.zeros(3)
    header.offsets = np.rint(middle)
    header.generating_software = "fovea"
    header.add_extra_dims([laspy.ExtraBytesParams(name, kind) for name, kind in _EXTRA.items()])
    with laspy.open(las, "w", header=header) as writer:
        for begin in range(0, len(points), _CHUNK):
            columns = las_columns(points[begin:begin + _CHUNK])
            record = laspy.ScaleAwarePointRecord.zeros(len(columns["xyz"]), header=header)
            for axis, name in enumerate("xyz"):
                record[name] = columns["xyz"][:, axis]
            for name, column in columns.items():
                if name != "xyz":
                    record[name] = column
            writer.write_points(record)


def _compress(las: pathlib.Path, laz: pathlib.Path) -> None:
    laspy = load("laspy", "laz")
    load("lazrs", "laz")
    with laspy.open(las) as reader:
        with laspy.open(laz, "w", header=reader.header, do_compress=True) as writer:
            for chunk in reader.chunk_iterator(_CHUNK):
                writer.write_points(chunk)


def write(source: Union[_map.Map, _map.Points, _Path], output: _Path, *, force: bool = False,
          **options: Any) -> None:
    """Writes a map, or points of one, as LAZ, or as COPC if output ends in .copc.laz.

    source: a Map or its path: the file has what Map.export() writes into LAS, with its CRS and
    GPS times, a tile at a time. Points: in their own frame, m, without CRS and times.
    options: those of Map.export(), for a map: where, crs, exposure, uncolored, color_depth,
    utc_offset. force: replaces output. COPC takes 60 bytes of memory a point.

    ImportError without laspy, lazrs or copclib; ConfigError for another ending, and for options
    of points; OutputError for an output that exists; else as Map.export().
    """
    path = pathlib.Path(output)
    if not path.name.endswith(".laz"):
        raise ConfigError(f"the output is no LAZ file, {path}, give a name that ends in .laz")
    if options and isinstance(source, _map.Points):
        raise ConfigError(f"points have no options, {', '.join(options)}, choose points before")
    if not force and path.exists():
        raise OutputError(f"the output exists, {path}, give another name, or force=True")
    if not path.parent.is_dir():
        raise OutputError(f"the folder does not exist, {path.parent}, make it first")
    is_copc = path.name.endswith(".copc.laz")
    for module in ("laspy", "copclib" if is_copc else "lazrs"):
        load(module, "laz")
    with tempfile.TemporaryDirectory(dir=path.parent, prefix=f".{path.name}.") as folder:
        las, made = pathlib.Path(folder) / "points.las", pathlib.Path(folder) / "made.copc.laz"
        if isinstance(source, _map.Points):
            _write_las_of_points(source, las)
        else:
            opened = source if isinstance(source, _map.Map) else _map.Map(source)
            opened.export(las, "las", **options)
        if is_copc:
            from ._copc import write_copc

            write_copc(las, made)
        else:
            _compress(las, made)
        os.replace(made, path)
