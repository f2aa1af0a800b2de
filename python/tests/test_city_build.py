"""python3 -m fovea.city: plan, build, add, remove, status and root, with a program that takes milliseconds."""
import json
import os
import subprocess
import unittest

import city_fake
from city_command import CROSSING, FAR, CityTestCase


class BuildTest(CityTestCase):
    def test_makes_a_city(self):
        drives = self.drives()
        out, err = self.build(*drives)
        self.assertIn("3 drives, 0.6 km", out)
        self.assertIn("3 maps, 3 pairs", err)
        manifest = self.manifest()
        self.assertEqual((manifest["fovea_city"], manifest["revision"]), (1, 1))
        self.assertEqual([drive["name"] for drive in manifest["drives"]], ["a", "b", "c"])
        self.assertEqual(manifest["drives"][0]["frames"], 151)
        self.assertEqual(manifest, json.loads((self.city / "manifests" / "1.json").read_text()))
        poses = json.loads((self.city / manifest["poses"]).read_text())
        self.assertEqual(manifest["origin"], poses["origin"])
        self.assertEqual(sorted((tile["x"], tile["y"]) for tile in manifest["tiles"]),
                         [(tile["x"], tile["y"]) for tile in manifest["tiles"]])
        for tile in manifest["tiles"]:
            file = self.city / tile["file"]
            self.assertEqual(tile["bytes"], file.stat().st_size)
            self.assertEqual(tile["points"], city_fake.read_map(file)[1])
            self.assertEqual(tile["revision"], 1)
        self.assert_clean()

    def test_a_second_build_does_nothing(self):
        drives = self.drives()
        self.build(*drives)
        before, calls = self.outputs(), self.folder / "calls"
        out, err = self.build(*drives[::-1], FAKE_CALLS=calls)
        self.assertIn("everything is done", out)
        self.assertEqual(err, "")
        self.assertEqual(self.outputs(), before)
        self.assertFalse(calls.exists())
        self.assertEqual(self.manifest()["revision"], 1)

    def test_does_what_is_missing(self):
        drives = self.drives()
        self.build(*drives)
        before, tile = self.outputs(), self.city / min(self.tiles())
        for file in (self.city / "pairs").iterdir():  # nothing that is missing needs them
            file.unlink()
        tile.unlink()
        out, err = self.build(*drives)
        self.assertTrue(err.startswith("1 tile:"), err)
        self.assertIn("revision 1", out)
        kept = {file: time for file, time in before.items() if file != tile and file.parent.name != "pairs"}
        after = self.outputs()
        del after[tile]
        self.assertEqual(after, kept)

    def test_tiles_without_points_are_not_in_the_manifest(self):
        drives = self.drives(**CROSSING, empty=[(0, 2000), (80, 2000)])
        self.build(*drives, "--session", "empty")
        self.assertGreater(len(list((self.city / "tiles").iterdir())), len(self.tiles()))

    def test_settings_are_passed_on(self):
        drives = self.drives()
        config, calls = self.folder / "settings.toml", self.folder / "calls"
        config.write_text("[foveal]\nperiphery_range_m = 40\n")
        self.build(*drives, "--set", "surface.spacing_m=0.1", "--config", config, "--cameras", "2,3", "--memory",
                   "2GiB", "--threads", 2, "--session", "latest", "--tile-size", 50, "--datum", "ETRS89",
                   "--epoch", 2020.5, "--heights", "ellipsoidal", FAKE_CALLS=calls)
        calls = calls.read_text().splitlines()
        by_kind = {line.split()[0]: line for line in calls}
        self.assertIn("--cameras 2,3", by_kind["catalog"])
        for text in ("--set surface.spacing_m=0.1", f"--config {config}", "--cameras 2,3", "--memory 2GiB",
                     "--threads 2", f"--scratch {self.scratch}", "--frames 0:"):
            self.assertIn(text, by_kind["map"])
        self.assertIn("--datum ETRS89 --epoch 2020.5 --heights ellipsoidal", by_kind["adjust"])
        for text in ("--session latest", "--tile-size 50", "--allow-empty", f"--scratch {self.scratch}"):
            self.assertIn(text, by_kind["fuse"])
        self.assertTrue(all("--if-missing" in line and "--quiet" not in line for line in calls))

    def test_quiet(self):
        self.assertEqual(self.build(*self.drives(), "--quiet"), ("", ""))


class PlanTest(CityTestCase):
    def test_any_engine_can_run_the_jobs(self):
        drives = self.drives()
        out, _ = self.run_city("plan", *drives, "-o", self.city)
        self.assertIn("3 map, 3 pair, 1 poses", out)
        listed = json.loads((self.city / "jobs.json").read_text())
        self.assertEqual(listed["fovea_city_jobs"], 1)
        jobs = [job for job in listed["jobs"] if job["kind"] != "catalog"]
        self.assertEqual([job["stage"] for job in jobs], sorted(job["stage"] for job in jobs))
        environment = {**os.environ, "FOVEA_PROGRAM": str(self.program)}
        for number, job in enumerate(jobs):
            for file in job["inputs"]:
                self.assertTrue((self.city / file).exists(), file)
            self.assertGreater(job["memory_mb"], 0)
            self.assertGreater(job["expected_s"], 0)
            command = job["command"] if number % 2 else ["bash", "-c", job["shell"]]
            subprocess.run(command, check=True, env=environment, stdout=subprocess.DEVNULL)
            self.assertTrue((self.city / job["outputs"][0]).exists(), job["outputs"])
        self.assertEqual(jobs[-1]["kind"], "root")
        planned = self.contents()
        self.city = self.folder / "built"
        self.build(*drives)
        self.assertEqual(self.contents(), planned)

    def test_root_reports_missing_tiles(self):
        self.run_city("plan", *self.drives(), "-o", self.city)
        for job in json.loads((self.city / "jobs.json").read_text())["jobs"][:-2]:
            subprocess.run(job["command"], check=True)
        out, err = self.run_city("root", self.city, code=1)
        self.assertIn("revision 1", out)
        self.assertIn("1 tiles are missing", err)

    def test_status_before_while_and_after(self):
        drives = self.drives()
        self.run_city("plan", *drives, "-o", self.city)
        out, _ = self.run_city("status", self.city)
        self.assertIn("no manifest yet", out)
        self.assertRegex(out, r"map +0 done, +3 missing, +0 failed")
        self.assertRegex(out, r"disk: .* used, about [1-9].* more for the missing jobs")
        build = self.start("build", *drives, "-o", self.city, "--workers", 1, FAKE_SLEEP=0.1)
        self.wait_for_job(build)
        self.assertIn(f"a build runs: process {build.pid}", self.run_city("status", self.city)[0])
        self.end(build)
        out, _ = self.run_city("status", self.city)
        self.assertIn("revision 1, 3 drives", out)
        self.assertRegex(out, r"map +3 done, +0 missing, +0 failed")
        self.assertIn("about 0.0 MB more", out)


class AddAndRemoveTest(CityTestCase):
    def test_add_and_remove(self):
        drives = self.drives(**CROSSING, **FAR)
        self.build(*drives[1:])
        first = self.tiles()
        before = self.outputs()
        self.run_city("add", drives[0], self.city)
        self.assertEqual(self.manifest()["revision"], 2)
        self.assertEqual([drive["name"] for drive in self.manifest()["drives"]], ["a", "b", "c", "far"])
        revisions = {tile["file"]: tile["revision"] for tile in self.manifest()["tiles"]}
        self.assertEqual(set(revisions.values()), {1, 2})
        self.assertEqual({file for file, revision in revisions.items() if revision == 1}, first & self.tiles())
        self.assertLessEqual(before.items(), self.outputs().items())

        out, _ = self.run_city("add", drives[0], self.city)
        self.assertIn("everything is done", out)

        added = self.tiles()
        self.run_city("remove", "a", self.city)
        self.assertEqual(self.tiles(), first)
        self.assertEqual(self.manifest()["revision"], 3)
        self.run_city("add", drives[0], self.city)  # with fixed poses that a part was taken from
        self.assertEqual(len(self.tiles()), len(added))
        for revision in (1, 2, 3, 4):
            old = json.loads((self.city / "manifests" / f"{revision}.json").read_text())
            self.assertEqual(old["revision"], revision)
            self.assertTrue(all((self.city / tile["file"]).exists() for tile in old["tiles"]))

    def test_add_needs_no_old_drive(self):
        drives = self.drives()
        self.build(*drives[:2])
        os.rename(drives[0], self.folder / "archived")
        self.run_city("add", drives[2], self.city)
        self.assertEqual(len(self.manifest()["drives"]), 3)

    def test_a_map_that_cannot_be_made_again(self):
        drives = self.drives()
        self.build(*drives[:2])
        city = self.manifest()
        for name in city["drives"][0]["maps"]:
            (self.city / name).unlink()
        os.rename(drives[0], self.folder / "archived")
        _, err = self.run_city("add", drives[2], self.city, "--retries", 0, code=1)
        self.assertIn("a map of the city is missing and cannot be made again: a frames 0:151", err)
        self.assertEqual(self.manifest(), city)

    def test_a_changed_drive_is_refused(self):
        drives = self.drives()
        self.build(*drives)
        (drives[0] / "more").write_text("")
        _, err = self.run_city("add", drives[0], self.city, code=1)
        self.assertIn("files of the drive have changed", err)
        self.assertIn("run `remove a` first", err)

    def test_remove_names_drives_of_the_city(self):
        drives = self.drives()
        self.build(*drives)
        self.assertIn("the city has no drive d", self.refuse("remove", "d", self.city))
        self.assertIn("no drive would be left", self.refuse("remove", "a", "b", "c", self.city))
        self.run_city("remove", drives[1], self.city)  # by its folder
        self.assertEqual([drive["name"] for drive in self.manifest()["drives"]], ["a", "c"])

    def test_add_after_the_drive_of_the_session_is_removed(self):
        drives = self.drives()
        self.build(*drives[:2], "--session", "a")
        self.run_city("remove", "a", self.city)
        self.run_city("add", drives[2], self.city)
        self.assertEqual([drive["name"] for drive in self.manifest()["drives"]], ["b", "c"])

    def test_add_and_remove_need_a_city(self):
        drives = self.drives()
        self.assertIn("the folder is not a city", self.refuse("add", drives[0], self.folder))
        self.run_city("plan", *drives, "-o", self.city)
        self.assertIn("the city has no manifest yet", self.refuse("remove", "a", self.city))


if __name__ == "__main__":
    unittest.main()
