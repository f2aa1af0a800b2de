"""python3 -m fovea.city: workers, schedulers, disks and drives that fail, with a program that takes milliseconds."""
import json
import os
import signal
import socket
import subprocess
import sys
import time
import unittest

import psutil

import city_fake
from city_command import CROSSING, FAR, CityTestCase


class FaultsTest(CityTestCase):
    def expected(self, drives):
        """The tiles of a build without faults, in another folder."""
        city, self.city = self.city, self.folder / "expected"
        self.build(*drives)
        contents, self.city = self.contents(), city
        return contents

    def test_any_number_of_workers_makes_the_same_city(self):
        drives = self.drives(**CROSSING, **FAR)
        expected = self.expected(drives)
        for workers in (1, 2, 4):
            self.city = self.folder / f"city of {workers}"
            self.run_city("build", *drives[::-1], "-o", self.city, "--workers", workers)
            self.assertEqual(self.contents(), expected)
            self.assert_clean()

    def test_a_killed_worker(self):
        drives = self.drives(**CROSSING, **FAR)
        expected = self.expected(drives)
        build = self.start("build", *drives, "-o", self.city, "--workers", 2, FAKE_SLEEP=0.3)
        job = self.wait_for_job(build)
        worker = psutil.Process(job.ppid())
        self.assertNotEqual(worker.pid, build.pid)
        worker.kill()
        job.wait(timeout=5)  # it ends with its worker
        _, err = self.end(build)
        self.assertNotIn("error", err)
        self.assertEqual(self.contents(), expected)
        self.assert_clean()

    def test_ctrl_c(self):
        drives = self.drives()
        expected = self.expected(drives)
        for number, code in ((signal.SIGINT, 130), (signal.SIGTERM, 143)):
            build = self.start("build", *drives, "-o", self.city, "--workers", 2, FAKE_SLEEP=20)
            job = self.wait_for_job(build)
            time.sleep(0.2)  # it writes
            os.kill(build.pid, number)
            _, err = self.end(build, code=code)
            self.assertIn("interrupted: run the command again", err)
            self.assertFalse(job.is_running())
            self.assert_clean()
        self.build(*drives)
        self.assertEqual(self.contents(), expected)

    def test_broken_drives(self):
        drives = self.drives(**CROSSING, **FAR)
        expected = self.expected(drives)
        broken = [city_fake.write_drive(self.folder / f"broken {kind}", CROSSING["b"], fails=[kind])
                  for kind in ("catalog", "map")]
        _, err = self.build(*drives, *broken, code=1)
        errors = [line for line in err.splitlines() if "error" in line]
        self.assertEqual(len(errors), 2)
        for line, kind in zip(errors, ("catalog", "map")):
            self.assertIn(f"the job {kind} of broken {kind}", line)
            self.assertIn("the drive is broken", line)
            log = line.split("log: ")[1]
            self.assertIn("the drive is broken", (self.city / log).read_text())
        self.assertEqual(self.contents(), expected)
        out, _ = self.run_city("status", self.city)
        self.assertRegex(out, r"catalog +5 done, +0 missing, +1 failed")
        self.assertRegex(out, r"map +4 done, +0 missing, +1 failed")
        self.assertRegex(out, r"failed: map of broken map frames 0:141: the drive is broken, .*; log: /")

        calls = self.folder / "calls"
        self.build(*drives, *broken, "--retries", 0, code=1, FAKE_CALLS=calls)  # only what failed
        self.assertEqual([line.split()[0] for line in calls.read_text().splitlines()], ["catalog", "map"])

        drive = broken[1] / "drive.json"
        drive.write_text(json.dumps({**json.loads(drive.read_text()), "fails": []}))
        self.build(*drives, broken[1])
        self.assertEqual(len(self.manifest()["drives"]), 5)

    def test_a_broken_pair(self):
        drives = self.drives()
        for number in range(2):
            drives.append(city_fake.write_drive(self.folder / f"fails_align {number}", CROSSING["a"]))
        _, err = self.build(*drives, "--retries", 0, code=1)
        self.assertIn("the job pair of ", err)
        self.assertEqual(len(self.manifest()["drives"]), 5)

    def test_a_map_that_the_machine_fails_to_make_does_not_freeze_the_poses(self):
        drives = self.drives()
        self.build(*drives[:2])
        city, poses = self.manifest(), list((self.city / "poses").iterdir())
        for number, (fault, reason) in enumerate((("killed", "ended by signal 9"), ("full", "the disk is full"))):
            new = city_fake.write_drive(self.folder / f"new {number}", CROSSING["a"], **{fault: ["map"]})
            _, err = self.run_city("add", drives[2], new, self.city, "--retries", 0, code=1)
            self.assertIn(f"the job map of new {number} frames 0:151 failed: {reason}", err)
            self.assertIn("run add again", err)
            self.assertEqual(self.manifest(), city)
            self.assertEqual(list((self.city / "poses").iterdir()), poses)
        drive = new / "drive.json"
        drive.write_text(json.dumps({**json.loads(drive.read_text()), "full": []}))
        self.run_city("add", drives[2], new, self.city)
        self.assertEqual(len(self.manifest()["drives"]), 4)

    def test_a_full_disk_on_one_worker(self):
        drives = self.drives(**CROSSING, **FAR)
        expected = self.expected(drives)
        claim = self.folder / "claim"
        self.run_city("build", *drives, "-o", self.city, "--workers", 2, FAKE_FULL=claim, FAKE_SLEEP=0.2)
        self.assertTrue(claim.exists())
        self.assertEqual(self.contents(), expected)
        self.city = self.folder / "with one worker"
        claim.unlink()
        _, err = self.build(*drives, code=1, FAKE_FULL=claim)
        self.assertIn("the disk is full", err)
        self.assertFalse((self.city / "city.json").exists())
        self.build(*drives)
        self.assertEqual(self.contents(), expected)

    def test_old_partial_files_are_removed(self):
        drives = self.drives()
        self.build(*drives)
        left = self.city / "maps" / "x.fovea.host-1.partial"
        left.write_text("")
        (self.city / "tiles" / "folder.partial").mkdir()
        (self.city / "exports").mkdir()
        (self.city / "exports" / "las.jobs.json.1.partial").write_text("")
        for name in ("city.json", "jobs.json", "lock"):
            (self.city / f"{name}.1.partial").write_text("")
        self.build(*drives)
        self.assert_clean()


class SchedulerTest(CityTestCase):
    def setUp(self):
        super().setUp()
        with socket.socket() as free:
            free.bind(("127.0.0.1", 0))
            self.port = free.getsockname()[1]
        self.address = f"tcp://127.0.0.1:{self.port}"
        self.environment = {**os.environ, "FAKE_SLEEP": "0.3", "DASK_DISTRIBUTED__WORKER__PROFILE__ENABLED": "false"}

    def dask(self, module, *words):
        """Starts a part of Dask, which ends with the test."""
        process = subprocess.Popen([sys.executable, "-m", f"distributed.cli.{module}", *map(str, words),
                                    "--no-dashboard"], env=self.environment, cwd=self.folder,
                                   stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)

        def end():
            if process.poll() is None:
                process.terminate()
            process.wait(timeout=30)

        self.addCleanup(end)
        return process

    def scheduler(self):
        return self.dask("dask_scheduler", "--host", "127.0.0.1", "--port", self.port)

    def worker(self):
        return self.dask("dask_worker", self.address, "--nthreads", 1, "--no-nanny", "--resources", "fovea=1",
                         "--local-directory", self.folder / "dask")

    def test_a_scheduler_that_restarts(self):
        drives = self.drives(**CROSSING, **FAR)
        first, worker = self.scheduler(), self.worker()
        build = self.start("build", *drives, "-o", self.city, "--scheduler", self.address)
        while not list((self.city / "maps").glob("*.fovea")) if (self.city / "maps").exists() else True:
            self.assertIsNone(build.poll())
            time.sleep(0.05)
        first.kill()
        first.wait()
        worker.terminate()
        worker.wait()
        self.scheduler()
        self.worker()
        _, err = self.end(build)
        self.assertIn(f"the connection to {self.address} is lost", err)
        self.assertNotIn("error", err)
        contents = self.contents()
        self.city = self.folder / "expected"
        self.build(*drives)
        self.assertEqual(self.contents(), contents)


if __name__ == "__main__":
    unittest.main()
