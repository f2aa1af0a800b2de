"""What a user states once for a city (Settings) and for one run of its jobs (RunOptions)."""
from __future__ import annotations

import dataclasses
import pathlib
import re
import tomllib
from dataclasses import dataclass
from typing import Any

from .names import content_digest
from .problems import config_error, input_error

_PERIPHERY_KEY = "foveal.periphery_range_m"
_DEFAULT_RANGE_M = 60.0  # of foveal.periphery_range_m
_UNITS = {"": 1, "k": 1000, "m": 1000**2, "g": 1000**3, "ki": 1 << 10, "mi": 1 << 20, "gi": 1 << 30}


@dataclass(frozen=True)
class Settings:
    """Of a city. They are part of the names of its files, and its manifest keeps them."""

    tile_size_m: float = 64.0
    session: str = "best"
    segment_length_m: float = 1000.0
    map_arguments: tuple[str, ...] = ()  # --set KEY=VALUE and --hold-out SPEC of `fovea map`
    cameras: str | None = None  # of `fovea map` and `fovea catalog`
    config: str | None = None  # file of `fovea map --config`
    control: str | None = None  # file of surveyed points
    datum: str | None = None  # of drives that state none; likewise epoch_year and height_type
    epoch_year: float | None = None
    height_type: str | None = None

    def json(self) -> dict[str, Any]:
        """For a JSON file."""
        return {**dataclasses.asdict(self), "map_arguments": list(self.map_arguments)}

    @staticmethod
    def from_json(content: dict[str, Any]) -> Settings:
        """KeyError or TypeError if the content is something else."""
        values: dict[str, Any] = {**content, "map_arguments": tuple(content["map_arguments"])}
        return Settings(**values)

    @property
    def map_key(self) -> list[str]:
        """What the maps depend on."""
        return [*self.map_arguments, self.cameras or "",
                content_digest(pathlib.Path(self.config) if self.config else None)]

    @property
    def camera_arguments(self) -> list[str]:
        """Of `fovea map` and `fovea catalog`."""
        return ["--cameras", self.cameras] if self.cameras else []

    @property
    def poses_key(self) -> list[str]:
        """What the poses depend on, besides the maps and pairs."""
        control = content_digest(pathlib.Path(self.control) if self.control else None)
        return [control, *(str(stated) for stated in (self.datum, self.epoch_year, self.height_type))]

    @property
    def range_m(self) -> float:
        """The longest distance of a map's point from the path: that of the map's periphery."""
        ranges = [_DEFAULT_RANGE_M, _range_of_config(self.config)]
        for key, value in (argument.split("=", 1) for argument in self.map_arguments if "=" in argument):
            if key.strip() == _PERIPHERY_KEY:
                ranges.append(_number(value))
        return max(ranges)


def _number(text: object) -> float:
    try:
        return float(str(text))
    except ValueError:
        return 0.0  # `fovea map` refuses it


def _range_of_config(config: str | None) -> float:
    if config is None:
        return 0.0
    section, key = _PERIPHERY_KEY.split(".")
    try:
        content = tomllib.loads(pathlib.Path(config).read_text())
    except (OSError, ValueError) as error:
        raise input_error(f"the settings cannot be read ({error})", config, "give a TOML file of settings") from error
    table = content.get(section)
    return _number(table.get(key, 0)) if isinstance(table, dict) else 0.0


@dataclass(frozen=True)
class RunOptions:
    """Of a run. They change no file's content."""

    program: str = "fovea"
    version: str = ""  # of the program
    scheduler: str | None = None
    workers: int | None = None
    threads: int = 1  # of a job
    scratch: str = "/tmp"
    memory: str = "1GiB"  # of a job
    retries: int = 2
    quiet: bool = False

    @property
    def memory_bytes(self) -> int:
        """ConfigError if `memory` is no size."""
        match = re.fullmatch(r"\s*([0-9.]+)\s*([kmg]?i?)b?\s*", self.memory.lower())
        unit = _UNITS.get(match[2]) if match else None
        size = _number(match[1]) * unit if match and unit else 0
        if size <= 0:
            raise config_error(f'"{self.memory}" is no size', "--memory", "give a number with a unit, as in 1GiB")
        return int(size)
