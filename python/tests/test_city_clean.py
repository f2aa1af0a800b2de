"""python3 -m fovea.city clean: what is deleted and what stays, with a program that takes milliseconds."""
import json
import os
import shutil
import unittest
from unittest import mock

import city_fake
from city_command import CROSSING, FAR, CityTestCase
from fovea.city.clean import clean
from fovea.city.folder import CityFolder


class CleanTest(CityTestCase):
    def setUp(self):
        super().setUp()
        self.all_drives = self.drives(**CROSSING, **FAR)

    def three_revisions(self):
        """A city, also with a drive that is then removed."""
        self.build(*self.all_drives[1:])
        self.run_city("add", self.all_drives[0], self.city)
        self.run_city("remove", "a", self.city)
        self.assertEqual(self.manifest()["revision"], 3)
        for tile in (self.city / "tiles").glob("*.fovea"):  # as `fovea fuse` and `export` make them
            tile.with_suffix(".overview.glb").write_text("picture")
            for part in (f"las/{tile.stem}.las", f"3dtiles/{tile.stem}/tileset.json"):
                file = self.city / "exports" / part
                file.parent.mkdir(parents=True, exist_ok=True)
                file.write_text("part")

    def files(self):
        return {str(file.relative_to(self.city)) for file in self.city.rglob("*") if file.is_file()}

    def needed(self, manifest):
        """Files without which a manifest is of no use."""
        plan = manifest["plan"]
        return {manifest["poses"], *(tile["file"] for tile in manifest["tiles"]),
                *(tile["file"].replace(".fovea", ".overview.glb") for tile in manifest["tiles"]),
                *(f"catalog/{drive['catalog']}.json" for drive in plan["drives"]),
                *(f"maps/{entry['name']}.fovea" for drive in plan["drives"] for entry in drive["maps"]),
                *(f"poses/{entry['placed_by']}.json" for drive in plan["drives"] for entry in drive["maps"])}

    def manifests(self):
        return {int(file.stem): json.loads(file.read_text()) for file in (self.city / "manifests").iterdir()}

    def test_the_newest_revision_stays_whole(self):
        self.three_revisions()
        before, manifest, contents = self.files(), self.manifest(), self.contents()
        bytes_before = sum((self.city / file).stat().st_size for file in before)
        planned, _ = self.run_city("clean", self.city, "--dry-run")
        self.assertEqual(self.files(), before)
        out, err = self.run_city("clean", self.city)
        freed = before - self.files()
        freed_bytes = bytes_before - sum((self.city / file).stat().st_size for file in self.files())
        self.assertEqual(out, f"{self.city}: {len(freed)} files, {freed_bytes / 1e6:.1f} MB freed; kept: revision 3\n")
        self.assertEqual(planned, out.replace("freed;", "would be freed;"))
        self.assertEqual(err, "")
        kinds = {file.split("/")[0] for file in freed}
        self.assertEqual(kinds, {"catalog", "maps", "pairs", "poses", "tiles", "manifests", "logs", "exports"})
        self.assertEqual(set(self.manifests()), {3})
        self.assertLessEqual(self.needed(manifest), self.files())
        self.assertEqual((self.manifest(), self.contents()), (manifest, contents))

        calls = self.folder / "calls"
        out, _ = self.build(*self.all_drives[1:], FAKE_CALLS=calls)
        self.assertIn("everything is done", out)
        self.assertFalse(calls.exists())
        out, _ = self.run_city("clean", self.city)
        out, _ = self.run_city("clean", self.city)
        self.assertIn(": 0 files, 0.0 MB freed", out)
        self.run_city("add", self.all_drives[0], self.city)
        self.assertEqual(len(self.manifest()["drives"]), 4)
        self.run_city("remove", "a", "b", self.city)
        self.assert_clean()

    def test_exports_of_the_tiles_stay(self):
        self.three_revisions()
        kept = {tile["file"].removeprefix("tiles/").removesuffix(".fovea") for tile in self.manifest()["tiles"]}
        root = self.city / "exports" / "3dtiles" / "tileset.json"
        root.write_text(json.dumps([f"{tile}/tileset.json" for tile in kept]))
        self.run_city("clean", self.city)
        self.assertTrue(root.exists())
        self.assertEqual({file.stem for file in (self.city / "exports" / "las").iterdir()}, kept)
        self.assertEqual({file.parent.name for file in root.parent.glob("*/tileset.json")}, kept)

    def test_a_tileset_that_refers_to_deleted_tiles_is_deleted(self):
        self.three_revisions()
        exports = self.city / "exports" / "3dtiles"
        names = [file.name for file in exports.iterdir()]
        (exports / "tileset.json").write_text('"q/0.json"')
        (exports / "q").mkdir()
        (exports / "q" / "0.json").write_text(json.dumps([f"../{name}/tileset.json" for name in names]))
        (exports / "q" / "0.glb").write_text("points")
        self.run_city("clean", self.city)
        self.assertFalse({"tileset.json", "q"} & {file.name for file in exports.iterdir()})

    def test_unknown_files_stay(self):
        self.three_revisions()
        unknown = {"notes.txt", "maps/mine.fovea", "tiles/0_0_old.fovea", "manifests/copy of 1.json",
                   "exports/my/x.las", "exports/las/mine.las", "pairs/" + "g" * 20 + ".json",
                   "poses/" + "0" * 20 + ".json.bak"}
        for name in unknown:
            (self.city / name).parent.mkdir(exist_ok=True)
            (self.city / name).write_text("mine")
        partial = self.city / "maps" / ("0" * 20 + ".fovea.partial")  # of a job that runs
        partial.write_text("")
        out, _ = self.run_city("clean", self.city)
        self.assertTrue(out.endswith(f"; unknown files that stay: {len(unknown)}\n"), out)
        self.assertLessEqual(unknown, self.files())
        self.assertTrue(partial.exists())

    def test_keeps_several_revisions(self):
        self.three_revisions()
        before = self.files()
        out, _ = self.run_city("clean", self.city, "--keep", 2)
        self.assertIn("kept: revision 2, 3\n", out)
        manifests = self.manifests()
        self.assertEqual(set(manifests), {2, 3})
        for manifest in manifests.values():
            self.assertLessEqual(self.needed(manifest), self.files())
        out, _ = self.run_city("clean", self.city, "--keep", 7)
        self.assertIn("kept: revision 2, 3\n", out)
        self.assertLess(self.files(), before)
        shutil.copy(self.city / "manifests" / "2.json", self.city / "city.json")
        out, _ = self.run_city("remove", "far", self.city)
        self.assertIn("3 drives", out)

    def test_a_plan_that_is_under_way_stays(self):
        self.three_revisions()
        new = city_fake.write_drive(self.folder / "new", [(0, 30), (150, 30)])
        self.run_city("plan", new, *self.all_drives, "-o", self.city)
        self.run_city("clean", self.city)
        before, calls = self.outputs(), self.folder / "calls"
        self.build(*self.all_drives, FAKE_CALLS=calls)  # `plan` lists the outputs of drive a, which is removed
        self.assertNotIn("map", {line.split()[0] for line in calls.read_text().splitlines()})
        self.assertLessEqual(before.items(), self.outputs().items())

    def test_status_after_clean(self):
        self.three_revisions()
        jobs, _ = self.run_city("status", self.city)
        self.run_city("clean", self.city)
        out, _ = self.run_city("status", self.city)
        without_disk = [line for line in jobs.splitlines() if not line.startswith("disk")]
        self.assertEqual([line for line in out.splitlines() if not line.startswith("disk")], without_disk)
        self.assertRegex(out, r"map +3 done, +0 missing, +0 failed")
        used = sum((self.city / file).stat().st_size for file in self.files()
                   if "/" in file and not file.startswith("exports/"))
        self.assertIn(f"disk: {used / 1e6:.1f} MB used, about 0.0 MB more", out)

    def test_needs_the_lock_and_a_city(self):
        self.assertIn("the folder is not a city", self.refuse("clean", self.folder))
        self.run_city("plan", *self.all_drives, "-o", self.city)
        self.assertIn("the city has no manifest yet", self.refuse("clean", self.city))
        self.three_revisions()
        before = self.files()
        build = self.start("build", *self.all_drives, "-o", self.city, "--workers", 1, FAKE_SLEEP=5)
        self.wait_for_job(build)
        self.assertIn("another build has the city", self.refuse("clean", self.city))
        build.terminate()
        self.end(build, code=143)
        self.assertLessEqual(before, self.files() | {"jobs.json"})

    def test_a_power_cut(self):
        """After each deletion, all manifests that are left can be opened, and another run ends the work."""
        self.three_revisions()
        whole = self.folder / "whole"
        shutil.copytree(self.city, whole)
        clean(CityFolder(self.city), 1, False)
        expected, count = self.files(), 0
        while self.cut_after(count, whole):
            for manifest in self.manifests().values():
                self.assertLessEqual(self.needed(manifest), self.files())
            clean(CityFolder(self.city), 1, False)
            self.assertEqual({file for file in self.files() if ".partial" not in file}, expected)
            count += 1
        self.assertGreater(count, 20)

    def cut_after(self, count, whole):
        """Cleans a copy of the city `whole`, and stops after some deletions. Returns whether it has stopped."""
        shutil.rmtree(self.city)
        shutil.copytree(whole, self.city)
        left = iter(range(count))

        def unless_cut(function):
            def run(*words, **options):
                if next(left, None) is None:
                    raise KeyboardInterrupt
                return function(*words, **options)
            return run

        try:
            with mock.patch.object(os, "unlink", unless_cut(os.unlink)), \
                    mock.patch.object(os, "rename", unless_cut(os.rename)):
                clean(CityFolder(self.city), 1, False)
        except KeyboardInterrupt:
            return True
        return False


if __name__ == "__main__":
    unittest.main()
