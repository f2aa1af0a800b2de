"""Expected time, memory and disk space of jobs: the figures of docs/city.md, of one thread on one core."""
from __future__ import annotations

CATALOG_S = 0.3
MAP_S_PER_FRAME = 0.065
PAIR_S = 3.0
POSES_S_PER_MAP = 0.1
TILE_S = 0.2
TILE_S_PER_MAP = 2.0  # of those in its reach
ROOT_S = 1.0
EXPORT_S = 4.0  # of a tile

SMALL_JOB_MB = 256  # memory of a catalog, a pair and the manifest
POSES_MB_PER_MAP = 1  # and SMALL_JOB_MB

MAP_BYTES_PER_FRAME = 250_000
TILE_BYTES = 5_000_000
JSON_BYTES = 100_000  # a catalog, a pair, and a map in the poses
