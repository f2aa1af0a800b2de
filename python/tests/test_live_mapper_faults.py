"""fovea.LiveMapper: wrong data, errors of the mapping thread, and ends of all kinds."""
import gc
import itertools
import signal
import subprocess
import sys
import threading
import unittest
import warnings
import weakref

import fovea
import numpy as np

import live_sample
import sample

CAMERA = live_sample.CAMERA
FIRST = 10  # scans that the beginning of a map waits for


def scan():
    return live_sample.frames()[0].points


class WrongData(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.mapper = live_sample.mapper("wrong.fovea")

    @classmethod
    def tearDownClass(cls):
        with unittest.TestCase().assertRaisesRegex(fovea.InputError, "before the first scan"):
            cls.mapper.close()
        cls.mapper = None

    def expect(self, error, name, *arguments, **keywords):
        with self.assertRaises(error, msg=(name, arguments)):
            getattr(self.mapper, name)(*arguments, **keywords)

    def test_scans(self):
        count = len(scan())
        for points in scan()[:, :2], scan()[0], np.zeros((3, 5)), np.zeros((2, 2, 3)):
            self.expect(ValueError, "add_scan", 1, points)
        for column in "intensity", "times", "rings":
            self.expect(ValueError, "add_scan", 1, scan(), **{column: np.zeros(count - 1)})
            self.expect(ValueError, "add_scan", 1, scan(), **{column: np.zeros((count, 1))})
        self.expect(ValueError, "add_scan", 1, scan(), rings=np.full(count, -1))
        self.expect(ValueError, "add_scan", 1, np.zeros((3, 4)), intensity=np.zeros(3))
        self.expect(TypeError, "add_scan", 1, "points")
        self.expect(TypeError, "add_scan", 1.5, scan())
        self.expect(TypeError, "add_scan", 2 ** 70, scan())
        self.expect(ValueError, "add_scan", 1, scan(), lidar="roof")

    def test_images(self):
        pixels = np.zeros((125, 414, 3), np.uint8)
        for image in pixels.astype(float), pixels[:, :, :2], pixels[0, 0], "image.png", None:
            self.expect(ValueError, "add_image", CAMERA, 1, image)
        self.expect(ValueError, "add_image", "rear", 1, pixels)
        self.expect(TypeError, "add_image", CAMERA, "now", pixels)

    def test_poses(self):
        for pose in np.eye(3), np.zeros((4, 4)), np.full((4, 4), np.nan), np.diag([2, 2, 2, 1]):
            self.expect(ValueError, "add_pose", 1, pose)
        for latitude in np.nan, np.inf:
            self.expect(ValueError, "add_position", 1, latitude, 8.4, 110)
        self.expect(ValueError, "add_position", 1, 49, 8.4, 110, accuracy=-1)
        self.expect(ValueError, "add_position", 1, 49, 8.4, 110, roll_pitch_yaw=[0, 0, np.nan])
        self.expect(TypeError, "add_position", 1, 49, 8.4, 110, roll_pitch_yaw=[0, 0])
        self.expect(TypeError, "add_imu", 1, [0, 0], [0, 0, 9.8])
        self.expect(ValueError, "add_imu", 1, [0, 0, np.inf], [0, 0, 9.8])
        self.expect(ValueError, "add_imu", 1, [0, 0, 0], [0, 0, 9.8], R_enu_imu=2 * np.eye(3))
        self.expect(ValueError, "add_wheel_speed", 1, np.nan)


class Beginning(unittest.TestCase):
    def test_a_drive_must_describe_the_sensors(self):
        for drive, error in [("version = 1\nlidars = 2\n", fovea.ConfigError),
                             (sample.folder() / "none.toml", fovea.InputError)]:
            with self.assertRaises(error):
                fovea.LiveMapper(drive, sample.folder() / "wrong.fovea", force=True)
        with self.assertRaises(fovea.ConfigError):
            live_sample.mapper("wrong.fovea", cameras=[7])
        with self.assertRaises(fovea.ConfigError):
            live_sample.mapper("wrong.fovea", max_wait=-1)
        with self.assertRaises(TypeError):
            live_sample.mapper("wrong.fovea", on_pose=3)
        with self.assertRaises(fovea.ConfigError):
            live_sample.mapper("wrong.fovea", preset="paper", on_pose=print, settings={})

    def test_outputs_are_not_replaced(self):
        with self.assertRaises(fovea.OutputError):
            live_sample.mapper(sample.map_file().name, force=False)
        with self.assertRaisesRegex(fovea.InputError, "not of a live drive"):
            live_sample.mapper(sample.map_file().name, force=False, resume=True)


class Ends(unittest.TestCase):
    def map_of(self, name):
        return fovea.Map(sample.folder() / name)

    def test_errors_of_the_map_are_raised_by_close_and_add(self):
        frame = live_sample.frames()[0]
        mapper = live_sample.mapper("small.fovea", expects_navigation=False)
        for number in range(FIRST):
            mapper.add_image(CAMERA, frame.stamp + number * 10 ** 8, np.zeros((9, 9), np.uint8))
            mapper.add_scan(frame.stamp + number * 10 ** 8, frame.points)
        for _ in range(2):
            with self.assertRaisesRegex(fovea.ConfigError, "9 x 9 pixels"):
                mapper.close()
        with self.assertRaisesRegex(fovea.ConfigError, "9 x 9 pixels"):
            mapper.add_scan(frame.stamp + 10 ** 10, frame.points)

    def test_data_after_the_end_are_dropped(self):
        with live_sample.mapper("ended.fovea") as mapper:
            live_sample.feed(mapper, 0, 3)
        mapper.add_scan(live_sample.frames()[5].stamp, scan())
        self.assertEqual(mapper.close()["live"]["scans"], 3)

    def test_what_on_pose_raises_ends_the_map(self):
        indices = []

        def stop(pose):
            indices.append(pose.index)
            if pose.index == 2:
                raise LookupError("enough")

        mapper = live_sample.mapper("raised.fovea", on_pose=stop)
        live_sample.feed_until_error(self, mapper, LookupError)
        for _ in range(2):
            with self.assertRaisesRegex(LookupError, "enough"):
                mapper.close()
        with self.assertRaisesRegex(LookupError, "enough"):
            mapper.add_wheel_speed(1, 1)
        self.assertEqual(indices, [0, 1, 2])
        self.assertIn(len(self.map_of("raised.fovea").frames), range(3, live_sample.FRAMES))

    def test_on_pose_may_not_call_its_mapper(self):
        mapper = live_sample.mapper("called.fovea", on_pose=lambda _: mapper.close())
        live_sample.feed(mapper, 0, 3)
        with self.assertRaisesRegex(RuntimeError, "on_pose calls the mapper"):
            mapper.close()

    def test_ctrl_c_ends_the_map(self):
        # The map begins when close() says that no more scans come. A second signal could arrive after
        # close() has returned.
        poses = itertools.count()
        mapper = live_sample.mapper(
            "interrupted.fovea",
            on_pose=lambda _: signal.raise_signal(signal.SIGINT) if next(poses) == 0 else None)
        live_sample.feed(mapper, 0, 4)
        with self.assertRaises(KeyboardInterrupt):
            mapper.close()
        self.assertEqual(len(self.map_of("interrupted.fovea").frames), mapper.close()["frames"])

    def test_an_exception_in_the_block_ends_the_map(self):
        tracked = threading.Event()
        with self.assertRaises(KeyError):
            with live_sample.mapper("block.fovea", on_pose=lambda _: tracked.set()) as mapper:
                live_sample.feed(mapper, 0, FIRST + 2)
                self.assertTrue(tracked.wait(60))
                raise KeyError
        mapper.add_scan(1, scan())
        self.assertEqual(mapper.figures["scans"], FIRST + 2)
        self.assertEqual(len(self.map_of("block.fovea").frames), mapper.close()["frames"])

    def test_the_exception_in_the_block_notes_that_of_the_map(self):
        tracked = threading.Event()

        def fail(_):
            tracked.set()
            raise LookupError("enough")

        with self.assertRaises(KeyError) as caught:
            with live_sample.mapper("noted.fovea", on_pose=fail) as mapper:
                live_sample.feed(mapper, 0, FIRST + 2)
                self.assertTrue(tracked.wait(60))
                while not hasattr(caught, "failed"):
                    try:
                        mapper.add_wheel_speed(1, 1)
                    except LookupError:
                        caught.failed = True
                raise KeyError
        self.assertIn("LookupError: enough", caught.exception.__notes__[0])


class Dropped(unittest.TestCase):
    def expect_a_warning(self, drop):
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            drop()
            gc.collect()
        self.assertIn(ResourceWarning, [warning.category for warning in caught])

    def test_a_mapper_that_is_dropped_ends(self):
        def drop():
            mapper = live_sample.mapper("dropped.fovea", on_pose=lambda _: None)
            live_sample.feed(mapper, 0, FIRST + 2)

        self.expect_a_warning(drop)

    def test_a_mapper_whose_on_pose_has_it_is_collected(self):
        class Robot:
            def __init__(self):
                self.mapper = live_sample.mapper("cycle.fovea", on_pose=self.show)

            def show(self, pose):
                pass

        robots = []

        def drop():
            robot = Robot()
            robots.append(weakref.ref(robot))
            live_sample.feed(robot.mapper, 0, FIRST + 2)

        self.expect_a_warning(drop)
        self.assertIsNone(robots[0]())

    def test_on_pose_may_drop_its_mapper(self):
        held, dropped = [], threading.Event()

        def drop(_):
            held.clear()
            dropped.set()

        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            held.append(live_sample.mapper("self.fovea", on_pose=drop))
            live_sample.feed(held[0], 0, FIRST + 2)
            self.assertTrue(dropped.wait(60))

    def test_a_program_ends_without_close(self):
        for ending in "", "; sys.exit(3)", "; raise KeyError":
            with self.subTest(ending=ending):
                run = subprocess.run([sys.executable, "-c", PROGRAM + ending, live_sample.drive(),
                                      sample.folder() / "program_end.fovea",
                                      live_sample.simulated()],
                                     timeout=120, stderr=subprocess.PIPE, text=True)
                self.assertEqual(run.returncode, {"": 0, "; sys.exit(3)": 3}.get(ending, 1),
                                 run.stderr)


# Sensors of a daemon thread never end; the mapper is a global of the program.
PROGRAM = """
import sys, threading, fovea
frames = list(fovea.Drive(sys.argv[3]))
tracked = threading.Event()
mapper = fovea.LiveMapper(sys.argv[1], sys.argv[2], force=True, every_frame=True, max_wait=1,
                          on_pose=lambda pose: tracked.set())
def send():
    number = 0
    while True:
        frame = frames[number % len(frames)]
        mapper.add_scan(frames[0].stamp + number * 10**8, frame.points, times=frame.time)
        number += 1
for _ in range(2):
    threading.Thread(target=send, daemon=True).start()
tracked.wait(60)
pass"""


if __name__ == "__main__":
    unittest.main()
