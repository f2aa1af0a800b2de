"""COPC: the points of a LAS file as an octree of LAZ chunks, with copclib."""
from __future__ import annotations

import pathlib
from typing import Any, Iterator, List, NamedTuple, Tuple

import numpy as np
import numpy.typing as npt

from ._extras import load

_BITS = 21  # of a coordinate in a code: the finest cells of the octree
_GRID_BITS = 7  # a node has at most one point in each of 128^3 cells, unless it is a leaf
_CHUNK = 1_000_000  # points whose codes are made at the same time
_LEAF = 50_000  # points of a node that is not divided

_Codes = npt.NDArray[np.uint64]
_Key = Tuple[int, int, int, int]  # depth, x, y, z


class Cube(NamedTuple):
    """The cube of the root, in the whole numbers of the LAS file. It has the longest edge of the
    points' box, as programs assume that take it from the header."""

    low: npt.NDArray[np.int64]
    edge: int


def cube_of(low: npt.NDArray[np.int64], high: npt.NDArray[np.int64]) -> Cube:
    """The cube at `low` that contains `high`."""
    return Cube(low, max(1, int((high - low).max())))


def _spread(values: _Codes) -> _Codes:
    """Puts two zero bits between the 21 lower bits."""
    for shift, mask in ((32, 0x1F00000000FFFF), (16, 0x1F0000FF0000FF), (8, 0x100F00F00F00F00F),
                        (4, 0x10C30C30C30C30C3), (2, 0x1249249249249249)):
        values = (values | (values << np.uint64(shift))) & np.uint64(mask)
    return values


def codes_of(xyz: npt.NDArray[np.int64], cube: Cube) -> _Codes:
    """Morton codes of N x 3 whole numbers: their leading 3 d bits are a node of depth d."""
    scaled = ((xyz - cube.low) << _BITS) // cube.edge
    cells = np.minimum(scaled, 2**_BITS - 1).astype(np.uint64)
    x, y, z = (_spread(cells[:, axis]) for axis in range(3))
    return (x << np.uint64(2)) | (y << np.uint64(1)) | z


def _children(codes: _Codes, key: _Key) -> Iterator[Tuple[_Key, slice]]:
    depth, x, y, z = key
    shift = np.uint64(3 * (_BITS - depth - 1))
    octants = (codes >> shift) & np.uint64(7)
    borders = np.searchsorted(octants, np.arange(9))
    for octant in range(8):
        if borders[octant] < borders[octant + 1]:
            child = (depth + 1, 2 * x + (octant >> 2), 2 * y + (octant >> 1 & 1),
                     2 * z + (octant & 1))
            yield child, slice(borders[octant], borders[octant + 1])


def nodes_of(codes: _Codes) -> Iterator[Tuple[_Key, npt.NDArray[np.int64]]]:
    """The nodes of an octree, and the numbers of their points. Each point is in one node.

    A node that is divided has a thinned picture of what is below.
    """
    order = np.argsort(codes, kind="stable")
    waiting: List[Tuple[_Key, npt.NDArray[np.int64]]] = [((0, 0, 0, 0), order)]
    while waiting:
        key, points = waiting.pop()
        depth = key[0]
        if len(points) <= _LEAF or depth + _GRID_BITS >= _BITS:
            yield key, points
            continue
        sorted_codes = codes[points]
        cells = sorted_codes >> np.uint64(3 * (_BITS - depth - _GRID_BITS))
        is_chosen = np.ones(len(points), bool)
        is_chosen[1:] = cells[1:] != cells[:-1]
        yield key, points[is_chosen]
        rest = ~is_chosen
        points, sorted_codes = points[rest], sorted_codes[rest]
        waiting.extend((child, points[part]) for child, part in _children(sorted_codes, key))


def _config(las: pathlib.Path, folder: pathlib.Path, cube: Cube) -> Any:
    """The header of the LAS file and its extra bytes, which copclib reads from LAZ alone."""
    laspy, copclib = load("laspy", "laz"), load("copclib", "laz")
    one = folder / "one.laz"
    with laspy.open(las) as reader:
        header = reader.header
        with laspy.open(one, "w", header=header, do_compress=True) as writer:
            if header.point_count:
                writer.write_points(reader.read_points(1))
    laz = copclib.LazReader(str(one)).laz_config
    # copclib 2.6.3 reads the WKT of a LAZ file 6 bytes too late.
    wkt = next((record.string for record in header.vlrs.get("WktCoordinateSystemVlr")), "")
    config = copclib.CopcConfigWriter(
        header.point_format.id, laz.las_header.scale, laz.las_header.offset, wkt,
        laz.extra_bytes_vlr)
    edge = cube.edge * float(header.scales[0])
    corner = cube.low * header.scales + header.offsets
    info, written = config.copc_info, config.las_header
    info.halfsize = edge / 2
    info.center_x, info.center_y, info.center_z = (float(c) + edge / 2 for c in corner)
    info.spacing = edge / 2**_GRID_BITS
    for name in ("global_encoding", "creation_day", "creation_year", "generating_software"):
        setattr(written, name, getattr(laz.las_header, name))
    if header.point_count:
        written.min, written.max = copclib.Vector3(*header.mins), copclib.Vector3(*header.maxs)
        written.points_by_return = [header.point_count] + 14 * [0]
    return config


def write_copc(las: pathlib.Path, output: pathlib.Path) -> None:
    """Writes the points of a LAS file with all their columns, and its CRS."""
    laspy, copclib = load("laspy", "laz"), load("copclib", "laz")
    with laspy.open(las) as reader:
        header = reader.header
        offset = header.offset_to_point_data
    records: Any = np.zeros(0, header.point_format.dtype())
    if header.point_count:
        records = np.memmap(las, header.point_format.dtype(), "r", offset,
                            (header.point_count,))
    corners = np.stack([header.mins, header.maxs])
    low, high = np.rint((corners - header.offsets) / header.scales).astype(np.int64)
    cube = cube_of(low, high)
    chunks = (records[begin:begin + _CHUNK] for begin in range(0, len(records), _CHUNK))
    codes = np.concatenate([np.zeros(0, np.uint64)] + [
        codes_of(np.stack([chunk[axis] for axis in "XYZ"], axis=1).astype(np.int64), cube)
        for chunk in chunks])
    writer = copclib.FileWriter(str(output), _config(las, output.parent, cube))
    for key, points in nodes_of(codes):
        if len(points):
            content = np.frombuffer(records[np.sort(points)].tobytes(), np.int8)
            writer.AddNode(copclib.VoxelKey(*key), copclib.VectorChar(content))
    writer.Close()
