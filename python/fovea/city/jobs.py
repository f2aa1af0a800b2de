"""Jobs: commands that read files and write one file, and the file jobs.json that lists them for any engine."""
from __future__ import annotations

import dataclasses
import os
import pathlib
import shlex
import sys
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from typing import Any

from . import costs
from .drives import Segment
from .ground import Cell
from .settings import RunOptions, Settings

EXPORT_FORMS = ("3dtiles", "las", "ply", "pcd")
STAGES = ("catalog", "map", "pair", "poses", "tile", "root", "export", "export root")  # kinds of jobs in their order


@dataclass(frozen=True)
class Job:
    """A command. `output` and the inputs are relative to the folder of the city, or absolute."""

    id: str
    kind: str  # of STAGES
    subject: str  # what it works on, for messages
    command: tuple[str, ...]
    output: str
    inputs: tuple[str, ...] = ()
    after: tuple[str, ...] = ()  # ids of jobs that make its inputs
    memory_mb: int = costs.SMALL_JOB_MB
    expected_s: float = 1.0

    @property
    def stage(self) -> int:
        """All jobs of one stage can run at the same time."""
        return STAGES.index(self.kind)

    @property
    def log(self) -> str:
        """Of its last run, relative to the folder of the city."""
        return f"logs/{self.id}.log"

    def json(self) -> dict[str, Any]:
        """For jobs.json."""
        content = dataclasses.asdict(self)
        output = content.pop("output")
        return {**content, "command": list(self.command), "shell": shlex.join(self.command),
                "inputs": list(self.inputs), "outputs": [output], "after": list(self.after), "stage": self.stage,
                "log": self.log, "expected_s": round(self.expected_s, 1)}

    @staticmethod
    def from_json(content: dict[str, Any]) -> Job:
        """KeyError or TypeError if the content is something else."""
        return Job(content["id"], content["kind"], content["subject"], tuple(content["command"]),
                   content["outputs"][0], tuple(content["inputs"]), tuple(content["after"]),
                   content["memory_mb"], content["expected_s"])


@dataclass(frozen=True)
class JobMaker:
    """Makes the jobs of a city. Names of maps, pairs and poses are hashes (names.py)."""

    city: str  # its folder, absolute
    settings: Settings
    options: RunOptions
    memory_mb: int = field(init=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "memory_mb", -(-self.options.memory_bytes >> 20))

    def catalog(self, folder: str, name: str) -> Job:
        """Lists what a planner needs of a drive."""
        output = f"catalog/{name}.json"
        command = self._fovea("catalog", [folder], output, *self.settings.camera_arguments)
        return Job(f"catalog-{name}", "catalog", os.path.basename(folder), command, output, (folder,),
                   expected_s=costs.CATALOG_S)

    def map(self, segment: Segment) -> Job:
        """Maps a segment."""
        output = map_file(segment.name)
        config = ["--config", self.settings.config] if self.settings.config else []
        command = self._fovea("map", [segment.drive.folder], output, "--frames", f"{segment.begin}:{segment.end}",
                              *self.settings.map_arguments, *self.settings.camera_arguments, *config,
                              *self._limits(scratch=True, memory=True))
        return Job(f"map-{segment.name}", "map", segment.text, command, output, (segment.drive.folder,),
                   memory_mb=self.memory_mb, expected_s=costs.MAP_S_PER_FRAME * (segment.end - segment.begin))

    def pair(self, name: str, a: Segment, b: Segment) -> Job:
        """Aligns two maps."""
        output, inputs = pair_file(name), (map_file(a.name), map_file(b.name))
        command = self._fovea("align", self._paths(inputs), output, *self._limits())
        return Job(f"pair-{name}", "pair", f"{a.text} and {b.text}", command, output, inputs,
                   (f"map-{a.name}", f"map-{b.name}"), expected_s=costs.PAIR_S)

    def poses(self, name: str, maps: Sequence[str], pairs: Sequence[str], fixed: str | None) -> Job:
        """Solves for the poses of all maps; those in the fixed poses stay as they are."""
        inputs = (*map(map_file, maps), *map(pair_file, pairs))
        extra = ["--fixed", self._path(poses_file(fixed))] if fixed else []
        for option, value in (("--control", self.settings.control), ("--datum", self.settings.datum),
                              ("--epoch", self.settings.epoch_year), ("--heights", self.settings.height_type)):
            extra += [option, str(value)] if value is not None else []
        command = self._fovea("adjust", self._paths(inputs), poses_file(name), *extra, *self._limits())
        after = (*(f"map-{m}" for m in maps), *(f"pair-{pair}" for pair in pairs))
        return Job(f"poses-{name}", "poses", f"{len(maps)} maps", command, poses_file(name),
                   (*inputs, *([poses_file(fixed)] if fixed else [])), after,
                   memory_mb=costs.SMALL_JOB_MB + costs.POSES_MB_PER_MAP * len(maps),
                   expected_s=costs.POSES_S_PER_MAP * len(maps))

    def kept_poses(self, name: str, numbers: Sequence[int], old: str) -> Job:
        """Copies the poses of some maps, given by their numbers in the old poses."""
        command = (*self._python("keep-poses"), self._path(poses_file(old)), self._path(poses_file(name)),
                   "--maps", ",".join(map(str, numbers)))
        return Job(f"poses-{name}", "poses", f"{len(numbers)} maps", command, poses_file(name), (poses_file(old),))

    def tile(self, tile: Cell, name: str, maps: Sequence[str], poses: str, session: str) -> Job:
        """Fuses one tile of all maps in its reach."""
        output, inputs = tile_file(tile, name), tuple(map(map_file, maps))
        place = f"{tile[0]},{tile[1]}"
        command = self._fovea("fuse", self._paths(inputs), output, "--poses", self._path(poses_file(poses)),
                              f"--tile={place}", "--tile-size", repr(float(self.settings.tile_size_m)),
                              "--session", session, "--allow-empty", *self._limits(scratch=True))
        after = (f"poses-{poses}", *(f"map-{m}" for m in maps))
        return Job(f"tile-{tile[0]}_{tile[1]}-{name}", "tile", f"tile {place}", command, output,
                   (poses_file(poses), *inputs), after, memory_mb=self.memory_mb,
                   expected_s=costs.TILE_S + costs.TILE_S_PER_MAP * len(maps))

    def root(self, tiles: Iterable[Job], poses: str) -> Job:
        """Writes the manifest."""
        jobs = list(tiles)
        return Job("root", "root", "manifest", (*self._python("root"), self.city), "city.json",
                   (poses_file(poses), *(job.output for job in jobs)), (f"poses-{poses}", *(job.id for job in jobs)),
                   expected_s=costs.ROOT_S)

    def export(self, tile: str, form: str) -> Job:
        """Exports a tile, given by its file."""
        name = pathlib.PurePath(tile).stem
        output = f"{export_folder(form)}/{name}" + ("" if form == "3dtiles" else f".{form}")
        coordinates = [] if form == "3dtiles" else ["--crs", "utm"]
        command = (self.options.program, "export", self._path(tile), self._path(output), "--if-missing",
                   "--format", form, "--exposure", "map", *coordinates)
        return Job(f"export-{form}-{name}", "export", f"tile {name}", command, output, (tile,),
                   expected_s=costs.EXPORT_S)

    def export_root(self, parts: Iterable[Job]) -> Job:
        """Writes the root of the tileset above its parts."""
        folder = export_folder("3dtiles")
        command = (self.options.program, "export", self._path("city.json"), self._path(folder),
                   "--format", "3dtiles", "--root-only", "--force")
        return Job("export-root", "export root", "the city", command, f"{folder}/tileset.json",
                   ("city.json",), tuple(part.id for part in parts), expected_s=costs.ROOT_S)

    def _fovea(self, command: str, inputs: Sequence[str], output: str, *options: str) -> tuple[str, ...]:
        return (self.options.program, command, *inputs, "-o", self._path(output), "--if-missing", *options)

    def _python(self, command: str) -> tuple[str, ...]:
        return (sys.executable, "-m", "fovea.city", command)

    def _limits(self, scratch: bool = False, memory: bool = False) -> list[str]:
        return ["--threads", str(self.options.threads), *(["--scratch", self.options.scratch] if scratch else []),
                *(["--memory", self.options.memory] if memory else [])]

    def _path(self, file: str) -> str:
        return os.path.join(self.city, file)

    def _paths(self, files: Iterable[str]) -> list[str]:
        return [self._path(file) for file in files]


def map_file(name: str) -> str:
    """Relative to the folder of the city; likewise the functions below."""
    return f"maps/{name}.fovea"


def pair_file(name: str) -> str:
    return f"pairs/{name}.json"


def export_folder(form: str) -> str:
    return f"exports/{form}"


def export_jobs_file(form: str) -> str:
    return f"exports/{form}.jobs.json"


def poses_file(name: str) -> str:
    return f"poses/{name}.json"


def tile_file(tile: Cell, name: str) -> str:
    return f"tiles/{tile[0]}_{tile[1]}_{name}.fovea"
