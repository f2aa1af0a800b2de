"""Parts of fovea.city, without processes: names of drives, the lock, the folder, options, and a client of Dask."""
import errno
import json
import os
import pathlib
import socket
import tempfile
import unittest
from unittest import mock

from fovea.city import lock, worker
from fovea.city.arguments import find_program, parser, settings_of
from fovea.city.drives import check_coordinates
from fovea.city.folder import FOLDERS, CityFolder, write_json
from fovea.city.jobs import Job
from fovea.city.names import drive_digest
from fovea.city.runner import Runner
from fovea.city.settings import RunOptions, Settings
from fovea.errors import ConfigError, InputError, OutputError

from city_sample import drive

LINE = [(0, 0), (100, 0)]


class FolderTestCase(unittest.TestCase):
    def setUp(self):
        made = tempfile.TemporaryDirectory(prefix="fovea_city_units_")
        self.addCleanup(made.cleanup)
        self.folder = pathlib.Path(made.name)

    def file(self, name, text=""):
        path = self.folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
        return path


class DigestTest(FolderTestCase):
    def assert_changes(self, name, text):
        before = drive_digest(self.folder / "drive")
        self.assertEqual(drive_digest(self.folder / "drive"), before)
        self.file(name, text)
        self.assertNotEqual(drive_digest(self.folder / "drive"), before)

    def test_linked_folders(self):
        self.file("disk/scans/1.bin")
        self.file("drive/drive.toml")
        (self.folder / "drive" / "scans").symlink_to(self.folder / "disk" / "scans")
        (self.folder / "disk" / "scans" / "circle").symlink_to(self.folder / "drive")
        self.assert_changes("disk/scans/1.bin", "longer")

    def test_the_drive_that_a_calibrated_drive_corrects(self):
        self.file("drive/drive.toml", '[calibrated]\ndrive = "../better"\n')
        self.file("better/drive.toml", f'[calibrated]\ndrive = "{self.folder}/recorded"\n')
        self.file("recorded/scans/1.bin")
        self.assert_changes("recorded/scans/1.bin", "longer")
        self.assert_changes("better/more", "")

    def test_calibrated_drives_that_cannot_be_read(self):
        for text in ('[calibrated]\ndrive = "."\n', '[calibrated]\ndrive = "../missing"\n', "calibrated = 1\n",
                     "[calibrated]\ndrive = 1\n", "[calibrated]\n", "[", '[calibrated]\ndrive = "../other"\n'):
            self.file("drive/drive.toml", text)
            self.file("other/drive.toml", '[calibrated]\ndrive = "../drive"\n')
            self.assert_changes("drive/more", text)

    def test_a_path_that_is_not_utf_8(self):
        folder = self.folder / os.fsdecode(b"\xff")
        folder.mkdir()
        with self.assertRaisesRegex(InputError, "the path of the drive is not UTF-8"):
            drive_digest(folder)


class CityFolderTest(FolderTestCase):
    def setUp(self):
        super().setUp()
        self.city = CityFolder(self.folder / "city")
        self.city.make()

    def names(self):
        return {path.name for path in self.city.path.iterdir()} - set(FOLDERS)

    def test_what_cannot_be_written_leaves_no_file(self):
        for value, text in ((os.fsdecode(b"\xff"), "is not UTF-8"), (float("nan"), "cannot be written"),
                            (float("inf"), "cannot be written")):
            with self.assertRaisesRegex(OutputError, text):
                write_json({"value": value}, self.city.jobs)
        with mock.patch("os.fsync", side_effect=OSError(errno.ENOSPC, "No space left")):
            with self.assertRaisesRegex(OutputError, "No space left"):
                write_json({}, self.city.jobs)
        self.assertEqual(self.names(), set())

    def test_partial_files_of_the_city_itself_are_removed(self):
        for name in ("city.json.7.partial", "jobs.json.7.partial", "lock.7.partial", "mine.partial", "city.json"):
            self.file(f"city/{name}")
        self.city.remove_partial_files()
        self.assertEqual(self.names(), {"mine.partial", "city.json"})

    def test_a_file_that_shows_late(self):
        self.assertFalse(self.city.has("maps/a.fovea"))
        self.assertFalse(self.city.has("no folder/a.fovea"))
        scandir = os.scandir

        def show(folder):
            self.file("city/maps/a.fovea")
            return scandir(folder)

        with mock.patch("os.scandir", side_effect=show):
            self.assertTrue(self.city.has("maps/a.fovea"))

    def test_a_full_disk_leaves_no_lock(self):
        with mock.patch.object(lock.json, "dump", side_effect=OSError(errno.ENOSPC, "No space left")):
            with self.assertRaisesRegex(OutputError, r"the lock cannot be made \(No space left\)"):
                lock.CityLock(self.city).__enter__()
        self.assertEqual(self.names(), set())
        with lock.CityLock(self.city):
            self.assertEqual(self.names(), {"lock"})
        self.assertEqual(self.names(), set())

    def test_a_lock_that_is_taken_meanwhile(self):
        dead = {"host": socket.gethostname(), "pid": os.getpid(), "process_start": "1", "start": "2026-01-01 00:00:00"}
        other = {**dead, "host": "elsewhere"}
        for error in (None, FileExistsError(errno.EEXIST, "exists"), PermissionError(errno.EPERM, "no links")):
            self.file("city/lock", json.dumps(dead))
            rename, link = os.rename, os.link

            def replace_first(source, target, rename=rename):
                if pathlib.Path(source).name == "lock":
                    self.file("city/lock", json.dumps(other))  # by another build, after the check
                rename(source, target)

            def refuse(source, target, error=error, link=link):
                if isinstance(error, FileExistsError):
                    self.file("city/lock", json.dumps(other))
                if error:
                    raise error
                link(source, target)

            with mock.patch("os.rename", replace_first), mock.patch("os.link", refuse):
                with self.assertRaisesRegex(OutputError, "another build has the city .*on elsewhere"):
                    lock.CityLock(self.city).__enter__()
            self.assertEqual(lock.read_lock(self.city.lock), other)
            self.assertEqual(self.names(), {"lock"})


class ScratchTest(FolderTestCase):
    def test_files_of_killed_jobs_are_removed(self):
        host, dead = socket.gethostname(), 2**22 + 1  # above all processes of Linux
        old = [f"a.fovea.{host}-{dead}-1.partial", f"a.fovea.{host}-{dead}-2.partial-wal"]
        kept = [f"a.fovea.{host}-{os.getpid()}-1.partial", f"a.fovea.other-{dead}-1.partial", f"a.{host}-{dead}-1"]
        for name in (*old, *kept):
            self.file(name)
        worker.remove_scratch_files(["fovea", "map", "--scratch", str(self.folder)])
        self.assertEqual(sorted(path.name for path in self.folder.iterdir()), sorted(kept))
        worker.remove_scratch_files(["fovea", "map", "--scratch", str(self.folder / "missing")])
        worker.remove_scratch_files(["fovea", "align"])


class OptionsTest(unittest.TestCase):
    def test_numbers_that_are_not_finite(self):
        for option, value in (("--tile-size", "nan"), ("--tile-size", "inf"), ("--segment-length", "nan"),
                              ("--segment-length", "inf"), ("--epoch", "nan"), ("--epoch", "inf")):
            arguments = parser().parse_args(["plan", "drive", "-o", "city", option, value])
            with self.assertRaisesRegex(ConfigError, option):
                settings_of(arguments)


class ProgramTest(FolderTestCase):
    def test_the_program_of_pip_precedes_that_of_the_shell(self):
        for name in ("pip", "shell"):
            program = self.folder / name / "fovea"
            program.parent.mkdir()
            program.write_text("#!/bin/sh\n")
            program.chmod(0o755)
        environment = {"PATH": str(self.folder / "shell")}
        with mock.patch.dict(os.environ, environment, clear=True), \
                mock.patch("sysconfig.get_path", return_value=str(self.folder / "pip")):
            self.assertEqual(find_program(), str(self.folder / "pip" / "fovea"))
            (self.folder / "pip" / "fovea").unlink()
            self.assertEqual(find_program(), str(self.folder / "shell" / "fovea"))
            (self.folder / "shell" / "fovea").unlink()
            self.assertRaises(ConfigError, find_program)
            os.environ["FOVEA_PROGRAM"] = "/bin/true"
            self.assertEqual(find_program(), "/bin/true")


class CoordinatesTest(unittest.TestCase):
    def test_drives_that_state_nothing(self):
        for key, name, stated, other in (("datum", "datum", "WGS 84", "ETRS89"), ("epoch_year", "epoch", 2010, 2020.5),
                                         ("height_type", "type of heights", "ellipsoidal", "orthometric")):
            drives = [drive("stated", LINE, **{key: stated}), drive("unknown", LINE)]
            with self.assertRaisesRegex(InputError, f"not all drives state the {name}.*not stated: unknown"):
                check_coordinates(drives, Settings())
            check_coordinates(drives, Settings(**{key: stated}))
            with self.assertRaisesRegex(InputError, f"the drives differ in the {name}"):
                check_coordinates(drives, Settings(**{key: other}))
            check_coordinates(drives[1:], Settings(**{key: other}))
            check_coordinates([*drives[1:], drive("other", LINE, **{key: other})], Settings(**{key: other}))


class FakeClient:
    """A client of Dask. Its first job fails on the first worker, the others end well."""

    status = "running"

    def __init__(self, workers):
        self.workers, self.submitted, self.calls = workers, [], []

    def scheduler_info(self):
        return {"workers": {address: {"resources": {"fovea": 1} if can_run else {}}
                            for address, can_run in self.workers.items()}}

    def submit(self, _, job, *__, workers, **___):
        self.submitted.append(workers)
        failed = len(self.submitted) == 1
        future = mock.Mock(status="error" if failed else "finished")
        future.exception.return_value = worker.JobError(job["id"], "it fails", min(self.workers)) if failed else None
        future.add_done_callback = lambda call: call(future)
        return future

    def cancel(self, futures, force):
        self.calls.append(("cancel", len(futures), force))

    def run(self, *_):
        self.calls.append("stop")

    def close(self, **_):
        self.calls.append("close")


class RunnerTest(FolderTestCase):
    def run_on(self, **workers):
        """Runs two jobs. Returns the client."""
        runner = Runner(CityFolder(self.folder), RunOptions(scheduler="tcp://fake:1"), self.fail)
        client = runner._client = FakeClient(workers)
        done = []
        with runner:
            jobs = [Job(name, "map", "", (), name) for name in "ab"]
            failures = runner.run(jobs, done.append, mock.Mock())
        self.assertEqual(failures, [])
        self.assertEqual({job.id for job in done}, {"a", "b"})
        return client

    def test_a_job_is_tried_again_on_a_worker_that_can_run_it(self):
        self.assertEqual(self.run_on(w1=True, w2=True, w3=False).submitted, [None, None, ["w2"]])
        self.assertEqual(self.run_on(w1=True, w2=False).submitted, [None, None, None])

    def test_the_end_cancels_jobs_before_it_stops_them(self):
        self.assertEqual(self.run_on(w1=True).calls, [("cancel", 1, True), "stop", "close"])


if __name__ == "__main__":
    unittest.main()
