"""What a planner needs of a drive: the file that `fovea catalog` writes, and the segments that a drive is mapped in."""
from __future__ import annotations

import json
import math
import pathlib
from dataclasses import dataclass
from typing import Any

from .ground import Place
from .problems import input_error

_VERSION = 1
_OVERLAP_M = 20.0  # of way, of two segments that follow each other
_REMEDY = "remove the file, and run the command again"


@dataclass(frozen=True)
class Sample:
    """A place of a drive's path."""

    frame: int
    along_m: float  # way from the begin of the drive
    place: Place


@dataclass(frozen=True)
class Catalog:
    """A drive. Frames are [begin, end). `samples` lie about 5 m apart; none without a georeference."""

    name: str
    path: str
    begin: int
    end: int
    session: str | None
    length_m: float
    accuracy_m: float | None  # of the navigation, one sigma
    datum: str | None
    epoch_year: float | None
    height_type: str | None
    calibration_fingerprint: str
    stamps_fingerprint: str
    warnings: tuple[str, ...]
    samples: tuple[Sample, ...]


@dataclass(frozen=True)
class Section:
    """Frames [begin, end) of a drive that become one map, with the samples in them."""

    begin: int
    end: int
    samples: tuple[Sample, ...]


def read_catalog(file: pathlib.Path) -> Catalog:
    """Reads a catalog. InputError if the file is missing, damaged or of another version."""
    try:
        content = json.loads(file.read_text())
    except OSError as error:
        raise input_error("the catalog of a drive is missing", file, "run build again") from error
    except ValueError as error:
        raise input_error("the catalog of a drive is damaged", file, _REMEDY) from error
    try:
        if content["fovea_catalog"] != _VERSION:
            raise input_error("the catalog of a drive has another version", file, _REMEDY)
        return _catalog_from(content)
    except (KeyError, TypeError, ValueError) as error:
        raise input_error(f"the catalog of a drive is damaged ({error})", file, _REMEDY) from error


def _catalog_from(content: dict[str, Any]) -> Catalog:
    samples = [
        Sample(int(item["frame"]), float(item["along_m"]),
               Place(float(item["latitude_deg"]), float(item["longitude_deg"]), float(item["height_m"])))
        for item in content["places"]]
    return Catalog(
        name=str(content["name"]), path=str(content["path"]), begin=int(content["begin"]), end=int(content["end"]),
        session=content["session"], length_m=float(content["length_m"]), accuracy_m=content["accuracy_m"],
        datum=content["datum"], epoch_year=content["epoch_year"], height_type=content["height_type"],
        calibration_fingerprint=content["calibration_fingerprint"] or "",
        stamps_fingerprint=content["stamps_fingerprint"] or "", warnings=tuple(content["warnings"]),
        samples=tuple(samples) if content["georeferenced"] else ())


def sections_of(catalog: Catalog, length_m: float) -> list[Section]:
    """Cuts a drive into sections of equal way, at most `length_m` each without their overlap of about 20 m."""
    samples = catalog.samples
    way = samples[-1].along_m if samples else 0.0
    count = max(1, math.ceil(way / length_m - 1e-9))
    if count == 1:
        return [Section(catalog.begin, catalog.end, samples)]
    sections = []
    for k in range(count):
        begin, end = catalog.begin, catalog.end
        if k > 0:
            start_m = k * way / count - _OVERLAP_M / 2
            begin = max(sample.frame for sample in samples if sample.along_m <= start_m or sample is samples[0])
        if k < count - 1:
            stop_m = (k + 1) * way / count + _OVERLAP_M / 2
            end = min(sample.frame for sample in samples if sample.along_m >= stop_m or sample is samples[-1]) + 1
        inside = tuple(sample for sample in samples if begin <= sample.frame < end)
        sections.append(Section(begin, end, inside))
    return sections
