"""python3 -m fovea.city with the program itself: a small simulated town."""
import functools
import json
import pathlib
import shutil
import stat
import subprocess
import unittest

import fovea
import psutil

import sample
from city_command import CityTestCase

FRAMES = 16
ROUTES = {"a": ("0,0 1,0", 12), "b": ("0,0 1,0", 16), "c": ("0,1 0,0", 32), "d": ("1,0 0,0", 55)}
SIMULATED = ["lidar.columns=1000", "camera.numbers=[2]", "camera.width=414", "camera.height=125", "camera.focal=240.5",
             "camera.cx=203.2", "camera.cy=57.6", "town.blocks_x=1", "town.blocks_y=1"]
OWN_MOUNTS = ["unshare", "--user", "--map-root-user", "--mount"]
SETTINGS = ["--set", "surface.spacing_m=0.1", "--tile-size", 32]


@functools.lru_cache(maxsize=None)
def town_drive(name):
    """Simulates a drive of the town; each has its own day."""
    drive = sample.folder() / "town" / name
    drive.parent.mkdir(exist_ok=True)
    route, begin = ROUTES[name]
    settings = [*SIMULATED, f"drive.pass={ord(name) - ord('a') + 1}", f"town.route={route}", f"town.begin={begin}"]
    sample.run("simulate", "-o", drive, "--scene", "town", "--format", "generic", "--frames", FRAMES, "--quiet",
               *(word for setting in settings for word in ("--set", setting)))
    shutil.rmtree(drive / "truth")
    return drive


@functools.lru_cache(maxsize=None)
def digest(tile):
    """Of a map."""
    return sample.run("info", tile, "--digest").strip()


def contents_of(folder):
    """Of all files in it."""
    return {file.relative_to(folder): file.read_bytes() for file in folder.rglob("*") if file.is_file()}


def can_mount():
    """Whether a test can mount a file system that only its own processes see."""
    return subprocess.run([*OWN_MOUNTS, "mount", "-t", "tmpfs", "none", "/mnt"], stderr=subprocess.DEVNULL,
                          check=False).returncode == 0


def points_of(manifest):
    """By tile."""
    return {(tile["x"], tile["y"]): tile["points"] for tile in manifest["tiles"]}


class TownTest(CityTestCase):
    program = pathlib.Path(sample.PROGRAM).resolve()

    def setUp(self):
        super().setUp()
        self.drives = [town_drive(name) for name in "abc"]

    def digests(self):
        """Of the city, and of its tiles."""
        tiles = {file: digest(self.city / file) for file in self.tiles()}
        return {**tiles, "city": sample.run("info", self.city, "--digest")}

    def expected(self):
        """The digests of a build on one worker without faults."""
        city, self.city = self.city, sample.folder() / "expected city"
        if not self.city.exists():
            _, err = self.run_city("build", *self.drives, "-o", self.city, *SETTINGS, "--workers", 1)
            self.assertIn("3 maps, 3 pairs", err)
        digests, self.city = self.digests(), city
        return digests

    def test_the_maps_of_the_town_fit(self):
        self.assertGreaterEqual(len(self.expected()), 6)
        self.city = sample.folder() / "expected city"
        manifest = self.manifest()
        poses = json.loads((self.city / manifest["poses"]).read_text())
        self.assertEqual(manifest["origin"], poses["origin"])
        matches = {placed["drive"]: placed["matches"] for placed in poses["maps"]}
        self.assertGreater(min(matches.values()), 0, matches)
        info = json.loads(sample.run("info", self.city / manifest["tiles"][0]["file"], "--json"))
        self.assertEqual(info["points"], manifest["tiles"][0]["points"])
        before = self.manifest()
        out, err = self.run_city("build", *self.drives[::-1], "-o", self.city, *SETTINGS)
        self.assertIn("everything is done", out)
        self.assertEqual((err, self.manifest()), ("", before))

    def test_python_localizes_in_a_city(self):
        self.expected()
        drive = fovea.Drive(self.drives[0], frames=(0, 3), use_images=False)
        localizer = fovea.Localizer(sample.folder() / "expected city", drive)
        self.assertEqual([localizer.localize(frame).state for frame in drive], ["localized"] * 3)

    def test_a_killed_worker_of_two(self):
        expected = self.expected()
        build = self.start("build", *self.drives, "-o", self.city, *SETTINGS, "--workers", 2)
        job = self.wait_for_job(build)
        psutil.Process(job.ppid()).kill()
        job.wait(timeout=5)
        _, err = self.end(build)
        self.assertNotIn("error", err)
        self.assertEqual(self.digests(), expected)
        self.assertFalse((self.city / "lock").exists())
        self.assertEqual(list(self.city.rglob("*.partial*")), [])

    def test_a_full_disk_and_a_broken_drive_on_four(self):
        expected = self.expected()
        claim, limited = self.folder / "claim", self.folder / "fovea"
        limited.write_text(f"#!/bin/bash\nif [[ $1 == map ]]; then\n"
                           f"  mkdir {claim} 2>/dev/null && echo $PPID >{claim}/pid\n"
                           f"  [[ $(cat {claim}/pid) == $PPID ]] && ulimit -f 8\n"
                           f"fi\nexec {self.program} \"$@\"\n")
        limited.chmod(limited.stat().st_mode | stat.S_IXUSR)
        self.program = limited
        broken = self.folder / "broken"
        broken.mkdir()
        shutil.copy(self.drives[0] / "drive.toml", broken)
        _, err = self.run_city("build", broken, *self.drives, "-o", self.city, *SETTINGS, "--workers", 4, code=1)
        self.assertTrue(claim.exists())
        [line] = [line for line in err.splitlines() if "error" in line]
        self.assertIn("the job catalog of broken failed", line)
        self.assertEqual(self.digests(), expected)

    def program_with_full_disk(self, command, folder):
        """The program, whose `command` finds a full disk in a folder of the city."""
        full = self.folder / f"fovea with full {folder}"
        place = self.city / folder
        mount = f"mount -t tmpfs -o size=4k none {place} && head -c 1M /dev/zero >{place}/x 2>/dev/null"
        full.write_text(f"#!/bin/bash\nif [[ $1 == {command} ]]; then\n"
                        f"  exec {' '.join(OWN_MOUNTS)} bash -c '{mount}; exec \"$0\" \"$@\"' {self.program} \"$@\"\n"
                        f"fi\nexec {self.program} \"$@\"\n")
        full.chmod(full.stat().st_mode | stat.S_IXUSR)
        return full

    @unittest.skipUnless(can_mount(), "this user cannot mount a small file system")
    def test_a_full_shared_disk(self):
        expected = self.expected()
        shutil.copytree(sample.folder() / "expected city", self.city)
        whole, manifest, poses = self.program, self.manifest(), set((self.city / "poses").iterdir())
        self.program = self.program_with_full_disk("align", "pairs")
        _, err = self.run_city("add", town_drive("d"), self.city, code=1)
        self.assertIn("the disk is full (No space left on device)", err)
        self.assertIn("run add again", err)
        self.assertEqual((self.manifest(), set((self.city / "poses").iterdir())), (manifest, poses))
        self.program = whole
        tile = manifest["tiles"][0]["file"]
        (self.city / tile).unlink()
        self.program = self.program_with_full_disk("fuse", "tiles")
        _, err = self.run_city("build", *self.drives, "-o", self.city, *SETTINGS, code=1)
        self.assertIn("the disk is full (No space left on device)", err)
        [log] = (self.city / "logs").glob(f"tile-*{pathlib.Path(tile).stem.split('_')[-1]}.log")
        self.assertIn("# exit code 74 after", log.read_text())
        self.program = whole
        self.run_city("build", *self.drives, "-o", self.city, *SETTINGS)
        self.assertEqual(self.digests(), expected)
        self.run_city("add", town_drive("d"), self.city)
        added = json.loads((self.city / self.manifest()["poses"]).read_text())
        self.assertGreater({placed["drive"]: placed["matches"] for placed in added["maps"]}["d"], 0)

    def test_exports(self):
        self.expected()
        shutil.copytree(sample.folder() / "expected city", self.city)
        tiles = {pathlib.Path(tile["file"]).stem for tile in self.manifest()["tiles"]}
        self.run_city("export", self.city, "--format", "las", "--workers", 2)
        folder = self.city / "exports" / "las"
        self.assertEqual({file.name for file in folder.iterdir()}, {f"{tile}.las" for tile in tiles})
        self.run_city("export", self.city)
        folder = self.city / "exports" / "3dtiles"
        self.assertEqual({file.name for file in folder.iterdir()}, {*tiles, "q", "tileset.json"})
        root = (folder / "tileset.json").read_text()
        self.assertTrue(all(f"{tile}/tileset.json" in root for tile in tiles))
        before = {file: file.stat().st_mtime_ns for file in folder.glob("*/tileset.json")}
        self.run_city("export", self.city)
        self.assertEqual({file: file.stat().st_mtime_ns for file in folder.glob("*/tileset.json")}, before)

    def test_any_engine_can_run_the_exports(self):
        self.expected()
        shutil.copytree(sample.folder() / "expected city", self.city)
        count = len(self.manifest()["tiles"])
        for form, kinds in (("las", ["export"]), ("3dtiles", ["export", "export root"])):
            exports = self.city / "exports" / form
            self.run_city("export", self.city, "--format", form)
            expected = contents_of(exports)
            shutil.rmtree(exports)
            out, _ = self.run_city("export", self.city, "--format", form, "--plan")
            self.assertIn(f"{form}.jobs.json: {count + len(kinds) - 1} jobs ({count} export", out)
            self.assertEqual(contents_of(exports), {})
            listed = json.loads((self.city / "exports" / f"{form}.jobs.json").read_text())
            self.assertEqual((listed["fovea_city_jobs"], listed["revision"]), (1, 1))
            stages = {job["stage"]: job["kind"] for job in listed["jobs"]}
            self.assertEqual([stages[stage] for stage in sorted(stages)], kinds)
            made = set()
            for job in sorted(listed["jobs"][::-1], key=lambda job: job["stage"]):
                self.assertLessEqual(set(job["after"]), made)
                self.assertTrue(all((self.city / file).exists() for file in job["inputs"]))
                subprocess.run(["bash", "-c", job["shell"]], check=True, stdout=subprocess.DEVNULL)
                self.assertTrue((self.city / job["outputs"][0]).exists())
                made.add(job["id"])
            self.assertEqual(contents_of(exports), expected)

    def clean_and_build_again(self):
        """Nothing that the newest revision needs is missing afterwards."""
        before, digests, tiles = self.files(), self.digests(), {pathlib.Path(tile).stem for tile in self.tiles()}
        out, _ = self.run_city("clean", self.city)
        self.assertRegex(out, r": \d\d+ files, \d+\.\d MB freed; kept: revision 3\n$")
        exports = self.city / "exports" / "3dtiles"
        self.assertEqual({file.name for file in exports.iterdir()}, {*tiles, "q", "tileset.json"})
        self.assertLess(self.files().items(), before.items())
        self.assertIn(f": whole, {len(tiles)} tiles", sample.run("info", self.city, "--check"))
        self.assertTrue(all((self.city / tile).with_suffix(".overview.glb").exists() for tile in self.tiles()))
        out, _ = self.run_city("build", *self.drives, "-o", self.city, *SETTINGS)
        self.assertIn("everything is done", out)
        self.assertEqual(self.digests(), digests)

    def files(self):
        """Of the city, and when they were written."""
        return {file: file.stat().st_mtime_ns for file in self.city.rglob("*") if file.is_file()}

    def test_add_and_remove(self):
        expected = self.expected()
        shutil.copytree(sample.folder() / "expected city", self.city)
        new = town_drive("d")
        self.run_city("add", new, self.city)
        manifest = self.manifest()
        self.assertEqual(len(manifest["drives"]), 4)
        self.assertNotEqual(self.digests(), expected)
        poses = json.loads((self.city / self.manifest()["poses"]).read_text())
        self.assertEqual({placed["drive"]: placed["fixed"] for placed in poses["maps"]},
                         {"a": True, "b": True, "c": True, "d": False})
        self.run_city("export", self.city)
        self.run_city("remove", "d", self.city)
        self.assertEqual(self.digests(), expected)
        self.run_city("export", self.city)
        self.clean_and_build_again()
        self.run_city("add", new, self.city)
        self.assertEqual(points_of(self.manifest()), points_of(manifest))


if __name__ == "__main__":
    unittest.main()
