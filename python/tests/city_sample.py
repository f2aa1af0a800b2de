"""Catalogs, plans and folders for the tests of fovea.city."""
import hashlib
import json
import pathlib
import tempfile

import city_fake
from fovea.city.catalog import read_catalog
from fovea.city.drives import Drive
from fovea.city.ground import Place
from fovea.city.jobs import JobMaker
from fovea.city.plan import FixedPoses, Request, make_plan, segments_of
from fovea.city.settings import RunOptions, Settings

VERSION = "fovea 1"


def drive(name, points, **other):
    """A drive by its catalog alone."""
    with tempfile.TemporaryDirectory() as folder:
        file = pathlib.Path(folder, "catalog.json")
        file.write_text(json.dumps(city_fake.catalog(name, points, **other)))
        catalog = read_catalog(file)
    return Drive(hashlib.sha256(name.encode()).hexdigest(), f"/drives/{name}", f"catalog-of-{name}", catalog)


def plan(drives, settings=Settings(), *, before=None, failed=(), kept=None):
    """The plan of some drives, or of `drives` added to the plan `before`; or `before` without all but `kept`."""
    segments = [segment for each in drives for segment in segments_of(each, settings, VERSION)]
    fixed = None
    if before is not None:
        fixed = FixedPoses(before.poses, tuple(segment.name for segment in before.segments), before.origin)
        segments += [segment for segment in before.segments if kept is None or segment.drive.catalog.name in kept]
    maker = JobMaker("/city", settings, RunOptions(version=VERSION))
    return make_plan(Request(settings, tuple(segments), fixed, frozenset(failed)), maker)


def jobs_of(made, kind):
    """The jobs of a kind, by their ids."""
    return {job.id: job for job in made.jobs if job.kind == kind}


def pairs_of(made):
    """The names of the drives of each pair, sorted."""
    names = {f"map-{segment.name}": segment.drive.catalog.name for segment in made.segments}
    return sorted(tuple(sorted(names[id] for id in job.after)) for job in jobs_of(made, "pair").values())


def place(latitude, longitude):
    """On the ground."""
    return Place(latitude, longitude, 0.0)
