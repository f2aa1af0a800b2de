"""The command export: a job for each tile of a city, and one for the root of a tileset."""
from __future__ import annotations

from typing import Any

from .build import CityBuild
from .jobs import export_folder


def export_city(build: CityBuild, manifest: dict[str, Any], form: str) -> list[str]:
    """Exports the tiles of a city that have no export yet, and the root of a tileset.

    @return what failed, a line each
    """
    folder = build.folder.path / export_folder(form)
    folder.mkdir(parents=True, exist_ok=True)
    parts = [build.maker.export(tile["file"], form) for tile in manifest["tiles"]]
    build.run_missing(parts)
    if form == "3dtiles" and not build.problems():
        root = build.maker.export_root(parts)
        (build.folder.path / root.output).unlink(missing_ok=True)  # it may be of another revision
        build.run_missing([root])
    return build.problems()
