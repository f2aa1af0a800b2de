"""python3 -m fovea.city: bad input. Each error is one line that states what is wrong, where, and what to do."""
import json
import os
import pathlib
import socket
import unittest

import city_fake
from city_command import CROSSING, CityTestCase


class BadInputTest(CityTestCase):
    def refused(self, drives, *words):
        """The line of a build that ends before any map."""
        _, err = self.run_city("build", *drives, "-o", self.city, "--quiet", *words, code=1)
        self.assertEqual(err.count("\n"), 1, err)
        self.assertEqual(list((self.city / "maps").iterdir()), [])
        return err

    def write(self, name, **other):
        return city_fake.write_drive(self.folder / name, CROSSING["a"], **other)

    def test_datum_epoch_and_heights(self):
        for key, option, values in (("datum", "--datum", ("WGS 84", "ETRS89")), ("epoch_year", "--epoch", (2010, 2020)),
                                    ("height_type", "--heights", ("ellipsoidal", "orthometric"))):
            first = self.write(f"{key} 1", **{key: values[0]})
            unknown, other = self.write(f"{key} 2"), self.write(f"{key} 3", **{key: values[1]})
            self.assertIn("the drives differ in the", self.refused([first, other]))
            line = self.refused([first, unknown])
            self.assertIn("not all drives state the", line)
            self.assertIn(f"give {option}", line)
            self.assertIn("the drives differ in the", self.refused([first, unknown], option, values[1]))
            self.run_city("plan", first, unknown, option, values[0], "-o", self.city)
            self.city = self.folder / f"next to {key}"

    def test_a_drive_given_twice(self):
        drive = self.write("a")
        link = self.folder / "link"
        link.symlink_to(drive)
        self.assertIn("a drive is given twice", self.refused([drive, link]))
        self.assertIn("a drive is given twice", self.refused([drive, f"{drive}/"]))
        copy = self.write("copy", stamps_fingerprint="a")
        self.assertIn(f"a drive is given twice, {drive} and {copy}", self.refused([drive, copy]))
        other = self.write("other", stamps_fingerprint="a", calibration_fingerprint="d")
        _, err = self.build(drive, other)
        self.assertIn("warning", err)
        self.assertIn("the same time stamps and path, and other calibrations", err)
        next_street = city_fake.write_drive(self.folder / "next", [(0, 30), (150, 30)], stamps_fingerprint="a")
        self.run_city("plan", drive, next_street, "-o", self.city)

    def test_a_drive_without_georeference_is_left_out(self):
        drives = self.drives()
        lost = self.write("lost", georeferenced=False, places=[])
        _, err = self.build(*drives, lost, code=1)
        self.assertIn("lost is left out: it has no georeference", err)
        self.assertEqual(len(self.manifest()["drives"]), 3)
        self.assertIn("lost is left out", self.run_city("status", self.city)[0])
        self.city = self.folder / "none"
        _, err = self.build(lost, code=1)
        self.assertIn("no drive can be part of the city", err)

    def test_a_drive_in_another_place_is_a_warning(self):
        _, err = self.build(*self.drives(), self.write("abroad", origin=(40.0, -74.0)))
        self.assertIn("abroad is near no other drive", err)
        self.assertEqual(len(self.manifest()["drives"]), 4)

    def test_files_of_other_versions(self):
        drives = self.drives()
        self.build(*drives)
        for name, key in (("city.json", "fovea_city"), ("jobs.json", "fovea_city_jobs")):
            file = self.city / name
            content = file.read_text()
            file.write_text(json.dumps({**json.loads(content), key: 2}))
            self.assertIn("has version 2", self.refuse("status", self.city))
            if name == "city.json":
                self.assertIn("has version 2", self.refuse("build", *drives, "-o", self.city))
                self.assertIn("has version 2", self.refuse("add", drives[0], self.city))
            file.write_text("{")
            self.assertIn("is damaged", self.refuse("status", self.city))
            file.write_text(content)

    def test_folders_and_programs(self):
        drives = self.drives()
        self.assertIn("the folder is not a city", self.refuse("build", *drives, "-o", self.folder))
        self.assertIn("the folder is not a city", self.refuse("status", self.folder))
        self.assertIn("the drive does not exist", self.refuse("build", self.folder / "no", "-o", self.city))
        self.program = pathlib.Path("/nonexistent/fovea")
        self.assertIn("the program fovea is missing", self.refuse("build", *drives, "-o", self.city))
        self.program = city_fake.__file__
        self.assertIn("is no size", self.refuse("build", *drives, "-o", self.city, "--memory", "much"))
        self.assertIn("a tile of 0 m", self.refuse("build", *drives, "-o", self.city, "--tile-size", 0))
        _, err = self.run_city("build", "-o", self.city, code=2)
        self.assertIn("DRIVE", err)
        self.assertIn("an existing scheduler has its own workers", self.refuse(
            "build", *drives, "-o", self.city, "--scheduler", "tcp://127.0.0.1:9", "--workers", 1))
        self.assertIn("there is no scheduler",
                      self.refuse("build", *drives, "-o", self.city, "--scheduler", "tcp://127.0.0.1:9"))

    def test_sessions_and_surveyed_points(self):
        drives = self.drives(**CROSSING, long=[(0, 0), (150, 0)])
        self.assertIn('no drive has the session "noon"', self.refused(drives, "--session", "noon"))
        points = self.folder / "points.csv"
        self.assertIn("the surveyed points cannot be read", self.refused(drives, "--control", points))
        points.write_text("name,role,latitude,longitude,height,sigma,map,x,y,z\np,control,49,8,100,0.01,long,1,2,3\n")
        line = self.refused(drives, "--control", points, "--segment-length", 100)
        self.assertIn("a surveyed point is in the drive long, which becomes 2 maps", line)

    def test_a_city_is_locked(self):
        drives = self.drives()
        build = self.start("build", *drives, "-o", self.city, "--workers", 1, FAKE_SLEEP=0.1)
        self.wait_for_job(build)
        line = self.refuse("build", *drives, "-o", self.city)
        self.assertIn(f"another build has the city (process {build.pid} on {socket.gethostname()}", line)
        self.end(build)

        lock = self.city / "lock"
        mine = {"host": socket.gethostname(), "pid": os.getpid(), "process_start": "1", "start": "2026-01-01 00:00:00"}
        lock.write_text(json.dumps(mine))
        _, err = self.build(*drives)
        self.assertIn("the lock of a build that has ended is replaced", err)
        self.assertFalse(lock.exists())
        lock.write_text(json.dumps({**mine, "host": "elsewhere"}))
        line = self.refuse("build", *drives, "-o", self.city)
        self.assertIn("on elsewhere since 2026-01-01", line)
        self.assertIn("or remove the file if no such process runs there", line)


if __name__ == "__main__":
    unittest.main()
