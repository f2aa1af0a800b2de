"""The command line of `python3 -m fovea.city`."""
from __future__ import annotations

import argparse
import math
import os
import shutil
import sysconfig
import tempfile

from .jobs import EXPORT_FORMS
from .problems import config_error
from .settings import RunOptions, Settings
from .worker import program_version


def parser() -> argparse.ArgumentParser:
    """Of all commands."""
    top = argparse.ArgumentParser(prog="python3 -m fovea.city", description="Many drives into one city (docs/city.md).")
    commands = top.add_subparsers(dest="command", required=True, metavar="COMMAND")
    for name, text in (("plan", "write CITY/jobs.json for another engine"),
                       ("build", "make the city of some drives, or what is missing of it")):
        command = commands.add_parser(name, help=text, description=text)
        command.add_argument("drives", nargs="+", metavar="DRIVE", help="folder of a drive (docs/drives.md)")
        command.add_argument("-o", "--output", required=True, metavar="CITY", help="folder of the city")
        _add_settings(command)
        _add_run_options(command)
    command = commands.add_parser("add", help="add drives; the poses of the others stay as they are")
    command.add_argument("drives", nargs="+", metavar="DRIVE", help="folder of a drive")
    command.add_argument("city", metavar="CITY", help="folder of the city")
    command.add_argument("--control", metavar="FILE.csv", help="surveyed points instead of those of build")
    _add_run_options(command)
    command = commands.add_parser("remove", help="take drives out; the poses of the others stay as they are")
    command.add_argument("names", nargs="+", metavar="NAME", help="name or folder of a drive")
    command.add_argument("city", metavar="CITY", help="folder of the city")
    _add_run_options(command)
    command = commands.add_parser("export", help="export all tiles, by a job each, to CITY/exports")
    command.add_argument("city", metavar="CITY", help="folder of the city")
    command.add_argument("--format", choices=EXPORT_FORMS, default="3dtiles",
                         help="one tileset (default), or a file for each tile")
    command.add_argument("--plan", action="store_true",
                         help="write CITY/exports/FORMAT.jobs.json for another engine, and run no job")
    _add_run_options(command)
    command = commands.add_parser("clean", help="delete the files that only older revisions need")
    command.add_argument("city", metavar="CITY", help="folder of the city")
    command.add_argument("--keep", type=_positive, default=1, metavar="N", help="newest revisions to keep (default: 1)")
    command.add_argument("--dry-run", action="store_true", help="delete nothing, print what would be freed")
    command = commands.add_parser("status", help="what is done, missing and failed, and the disk space")
    command.add_argument("city", metavar="CITY", help="folder of the city")
    command = commands.add_parser("root", help="the last job of jobs.json: writes the manifest of the tiles there are")
    command.add_argument("city", metavar="CITY", help="folder of the city")
    command = commands.add_parser("keep-poses", help="a job of jobs.json: copies the poses of some maps")
    command.add_argument("old", metavar="OLD.json")
    command.add_argument("new", metavar="NEW.json")
    command.add_argument("--maps", required=True, metavar="K,...", help="numbers of the maps in the old file")
    return top


def _add_settings(command: argparse.ArgumentParser) -> None:
    group = command.add_argument_group("the city")
    group.add_argument("--tile-size", type=float, default=64, metavar="M", help="edge of a tile (default: 64)")
    group.add_argument("--session", default="best", help="whose colors count first: best, latest, a day or a drive")
    group.add_argument("--segment-length", type=float, default=1000, metavar="M",
                       help="longer drives become several maps (default: 1000)")
    group.add_argument("--control", metavar="FILE.csv", help="surveyed points (docs/city.md)")
    group.add_argument("--config", metavar="FILE.toml", help="of `fovea map`")
    group.add_argument("--set", action="append", default=[], metavar="KEY=VALUE", help="of `fovea map`")
    group.add_argument("--cameras", metavar="K,...", help="of `fovea map`")
    group.add_argument("--hold-out", metavar="SPEC", help="of `fovea map`: frames that only get a pose")
    group.add_argument("--datum", help="of drives that state none")
    group.add_argument("--epoch", type=float, metavar="YEAR", help="of the datum, for drives that state none")
    group.add_argument("--heights", choices=("ellipsoidal", "orthometric"), help="of drives that state none")


def _add_run_options(command: argparse.ArgumentParser) -> None:
    group = command.add_argument_group("the run")
    group.add_argument("--scheduler", metavar="tcp://HOST:8786", help="of Dask (default: an embedded cluster)")
    group.add_argument("--workers", type=_positive, metavar="N", help="of the embedded cluster (default: the cores)")
    group.add_argument("--threads", type=_positive, default=1, metavar="N", help="of a job (default: 1)")
    group.add_argument("--memory", default="1GiB", metavar="SIZE", help="of a job (default: 1GiB)")
    group.add_argument("--scratch", metavar="DIR", help="folder on a local disk of each worker (default: $TMPDIR)")
    group.add_argument("--retries", type=_count, default=2, metavar="N",
                       help="times that a job is tried again, on another worker if there is one (default: 2)")
    group.add_argument("--quiet", action="store_true", help="print only errors")


def settings_of(arguments: argparse.Namespace) -> Settings:
    """Of plan and build. ConfigError if they contradict each other."""
    if not 1 <= arguments.tile_size <= 1000:
        raise config_error(f"a tile of {arguments.tile_size:g} m is not possible", "--tile-size", "give 1 to 1000")
    if not 50 <= arguments.segment_length < math.inf:
        raise config_error(f"segments of {arguments.segment_length:g} m are not possible", "--segment-length",
                           "give 50 or more")
    if arguments.epoch is not None and not math.isfinite(arguments.epoch):
        raise config_error(f"the epoch {arguments.epoch:g} is not possible", "--epoch", "give a year, as 2020.5")
    extra = [word for setting in arguments.set for word in ("--set", setting)]
    if arguments.hold_out:
        extra += ["--hold-out", arguments.hold_out]
    return Settings(arguments.tile_size, arguments.session, arguments.segment_length, tuple(extra),
                    arguments.cameras, _absolute(arguments.config), _absolute(arguments.control), arguments.datum,
                    arguments.epoch, arguments.heights)


def run_options_of(arguments: argparse.Namespace) -> RunOptions:
    """Of commands that run jobs. ConfigError if the program is missing."""
    program = find_program()
    scratch = os.path.abspath(arguments.scratch or tempfile.gettempdir())
    options = RunOptions(program, program_version(program), arguments.scheduler, arguments.workers, arguments.threads,
                         scratch, arguments.memory, arguments.retries, arguments.quiet)
    if not options.version:
        raise config_error("the program does not run", program, "build or install Fovea, or set FOVEA_PROGRAM")
    if options.scheduler is not None and options.workers is not None:
        raise config_error("an existing scheduler has its own workers", "--workers",
                           "leave out --workers or --scheduler")
    if options.scheduler is None and not os.path.isdir(scratch):
        raise config_error("the folder does not exist", scratch, "give a folder on a local disk with --scratch")
    assert options.memory_bytes > 0
    return options


def find_program() -> str:
    """The path of `fovea`: $FOVEA_PROGRAM, or that of pip next to this Python, or that of the shell.

    ConfigError if there is none.
    """
    named = os.environ.get("FOVEA_PROGRAM")
    installed_by_pip = None if named else shutil.which("fovea", path=sysconfig.get_path("scripts"))
    found = installed_by_pip or shutil.which(named or "fovea")
    if found is None:
        raise config_error("the program fovea is missing", named or "PATH",
                           "build or install Fovea, or name the program in FOVEA_PROGRAM")
    return os.path.abspath(found)


def _absolute(path: str | None) -> str | None:
    return None if path is None else os.path.abspath(path)


def _positive(text: str) -> int:
    value = int(text)
    if value < 1:
        raise argparse.ArgumentTypeError("give 1 or more")
    return value


def _count(text: str) -> int:
    value = int(text)
    if value < 0:
        raise argparse.ArgumentTypeError("give 0 or more")
    return value
