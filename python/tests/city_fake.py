#!/usr/bin/python3 -IS
"""A stand-in for the program `fovea` with the commands of a city, which take milliseconds, and drives for it.

A drive is a folder with drive.json: the catalog; `fails`, the kinds of its jobs that fail; `killed`, the kinds of its
jobs that a signal ends; and `full`, the kinds of its jobs that find a full disk. The environment has FAKE_SLEEP:
seconds that a map and a tile take; FAKE_CALLS: a file that lists the calls; FAKE_FULL: a file in which the first worker
that maps writes its process; a full disk is simulated on that worker.
"""
import hashlib
import json
import math
import os
import pathlib
import signal
import sqlite3
import sys
import time

M_PER_DEG = 111_200  # of latitude


def catalog(name, points, *, origin=(49.0, 8.4), sigma=0.4, first_frame=0, frame_m=1.0, **other):
    """A catalog of a drive along points (east, north) in m from an origin; a sample each 5 m or less."""
    places, along = [], 0.0
    for begin, end in zip(points, points[1:]):
        length = math.dist(begin, end)
        count = max(1, math.ceil(length / 5))
        for k in range(count + (end == points[-1])):
            way = along + length * k / count
            east, north = (b + (e - b) * k / count for b, e in zip(begin, end))
            latitude = origin[0] + north / M_PER_DEG
            longitude = origin[1] + east / (M_PER_DEG * math.cos(math.radians(latitude)))
            places.append({"frame": first_frame + round(way / frame_m), "along_m": way, "latitude_deg": latitude,
                           "longitude_deg": longitude, "height_m": 115.0})
        along += length
    end = places[-1]["frame"] + 1 if places else first_frame + 1
    return {"fovea_catalog": 1, "name": name, "path": f"/drives/{name}", "kind": "generic", "begin": first_frame,
            "end": end, "frames": end - first_frame, "session": "2026-01-01", "duration_s": 10.0, "length_m": along,
            "georeferenced": True, "accuracy_m": sigma, "datum": None, "epoch_year": None, "height_type": None,
            "calibration_fingerprint": "c", "stamps_fingerprint": name, "warnings": [], "places": places, **other}


def write_drive(folder, points, **other):
    """Writes a drive of this program. Returns its folder."""
    folder.mkdir(parents=True)
    (folder / "drive.json").write_text(json.dumps(catalog(folder.name, points, **other)))
    return folder


def _option(words, name):
    return words[words.index(name) + 1] if name in words else None


def _write(output, content):
    partial = pathlib.Path(f"{output}.{os.getpid()}.partial")
    partial.write_text(content)
    os.rename(partial, output)


def _write_map(output, text, points):
    partial = pathlib.Path(f"{output}.{os.getpid()}.partial")
    database = sqlite3.connect(partial)
    with database:
        database.execute("CREATE TABLE meta(text TEXT)")
        database.execute("CREATE TABLE tiles(points INTEGER)")
        database.execute("INSERT INTO meta VALUES(?)", [text])
        database.execute("INSERT INTO tiles VALUES(?)", [points])
    database.close()
    time.sleep(float(os.environ.get("FAKE_SLEEP", 0)))
    os.rename(partial, output)


def read_map(file):
    """The text and the points of a map of this program."""
    database = sqlite3.connect(f"file:{file}?immutable=1", uri=True)
    text, points = database.execute("SELECT text, points FROM meta, tiles").fetchone()
    database.close()
    return text, points


def _exit_on_full_disk():
    print("fovea: error: the disk is full (No space left on device), /scratch, free some space")
    sys.exit(74)


def _fail_on_full_disk():
    claim = os.environ.get("FAKE_FULL")
    if not claim:
        return
    try:
        with open(claim, "x", encoding="utf-8") as file:
            file.write(str(os.getppid()))
    except FileExistsError:
        pass
    if pathlib.Path(claim).read_text() == str(os.getppid()):
        _exit_on_full_disk()


def _drive(folder, kind):
    content = json.loads(pathlib.Path(folder, "drive.json").read_text())
    if kind in content.get("fails", []):
        sys.exit(f"fovea: error: the drive is broken, {folder}, repair it")
    if kind in content.get("full", []):
        _exit_on_full_disk()
    if kind in content.get("killed", []):
        os.kill(os.getpid(), signal.SIGKILL)
    return content


def run(words):
    """One command."""
    command, output = words[0], _option(words, "-o")
    if os.environ.get("FAKE_CALLS"):
        with open(os.environ["FAKE_CALLS"], "a", encoding="utf-8") as calls:
            calls.write(" ".join(words) + "\n")
    if os.path.exists(output):
        return
    files = [word for word in words[1:words.index("-o")]]
    if command == "catalog":
        _write(output, json.dumps(_drive(files[0], command)))
    elif command == "map":
        _fail_on_full_disk()
        content = _drive(files[0], command)
        text = json.dumps([content["name"], _option(words, "--frames"), content["places"][0]])
        _write_map(output, text, 1000)
    elif command == "align":
        if any("fails_align" in read_map(file)[0] for file in files):
            sys.exit("fovea: error: the maps are broken, align, repair them")
        _write(output, json.dumps({"verdict": "fits", "maps": [read_map(file)[0] for file in files]}))
    elif command == "adjust":
        _adjust(words, files, output)
    elif command == "fuse":
        texts = sorted(read_map(file)[0] for file in files)
        points = 0 if _option(words, "--session") == "empty" else 100 * len(texts)
        _write_map(output, json.dumps([words[words.index("--tile-size") - 1], texts]), points)


def _adjust(words, files, output):
    maps = [read_map(file)[0] for file in files if file.endswith(".fovea")]
    fixed = _option(words, "--fixed")
    old = json.loads(pathlib.Path(fixed).read_text()) if fixed else None
    digests = [hashlib.sha256(text.encode()).hexdigest() for text in maps]
    if old and not {placed["digest"] for placed in old["maps"]} <= set(digests):
        sys.exit("fovea: error: the fixed poses are of a map that is not given, adjust, give this map")
    first = json.loads(maps[0])[2]
    origin = {key: first[key] for key in ("latitude_deg", "longitude_deg", "height_m")}
    _write(output, json.dumps({"fovea_poses": 1, "origin": old["origin"] if old else origin,
                               "maps": [{"digest": digest} for digest in digests]}))


if __name__ == "__main__":
    if sys.argv[1:] == ["--version"]:
        print("fovea 0.0.fake")
    else:
        run(sys.argv[1:])
