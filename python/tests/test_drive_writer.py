"""fovea.DriveWriter, and the example of an adapter."""
import pathlib
import unittest

import fovea
import numpy as np

import sample
from test_examples import EXAMPLES, run_python

K = np.array([[50, 0, 31.5], [0, 50, 23.5], [0, 0, 1.0]])
START, STEP = 1_700_000_000_000_000_000, 100_000_000


def camera(**changes):
    return fovea.CameraModel(**{"width": 64, "height": 48, "K": K, "T_lidar_cam": np.eye(4), **changes})


def points(count=50):
    return np.random.default_rng(1).uniform(2, 9, (count, 3)).astype(np.float32)


def pose(frame):
    T = np.eye(4)
    T[0, 3] = frame
    return T


class DriveWriterTest(unittest.TestCase):
    def test_the_drive_has_what_was_added(self):
        path = sample.folder() / "written"
        image = np.arange(64 * 48 * 3, dtype=np.uint8).reshape(48, 64, 3)
        with fovea.DriveWriter(path, cameras={"front": camera()}, force=True) as writer:
            for frame in range(3):
                writer.add(points(), START + frame * STEP, intensity=np.full(50, 0.5),
                           times=np.linspace(-0.05, 0.05, 50), images={"front": image},
                           image_stamps={"front": START + frame * STEP + 5_000_000},
                           T_world_lidar=pose(frame))
        drive = fovea.Drive(path)
        self.assertEqual(len(drive.frames), 3)
        frame = drive.load(1)
        np.testing.assert_array_equal(frame.points, points())
        np.testing.assert_array_equal(frame.images[0], image)
        np.testing.assert_allclose(frame.time, np.linspace(-0.05, 0.05, 50), atol=1e-7)
        np.testing.assert_array_equal(drive.cameras[0].K, K)

    def test_a_further_lidar_has_scans_of_its_own(self):
        path = sample.folder() / "two_lidars"
        with fovea.DriveWriter(path, further_lidars={"left": pose(1)}, force=True) as writer:
            for frame in range(2):
                writer.add(points(), START + frame * STEP)
                writer.add_scan("left", points(), START + frame * STEP, times=np.zeros(50))
            with self.assertRaises(ValueError):
                writer.add_scan("right", points(), START + 2 * STEP)
        frame = fovea.Drive(path).load(1)
        self.assertEqual(len(frame.points), 100)
        np.testing.assert_array_equal(frame.sensor, np.repeat([0, 1], 50))
        np.testing.assert_allclose(frame.points[50:], points() + pose(1)[:3, 3], atol=1e-5)

    def test_close_tells_what_was_written(self):
        writer = fovea.DriveWriter(sample.folder() / "closed", force=True)
        bad = points()
        bad[3] = np.nan
        writer.add(bad, START)
        late = np.arange(len(bad)) * 5000.0  # microseconds
        with self.assertRaisesRegex(fovea.InputError, "over 1 s off the stamp"):
            writer.add(points(), START + STEP, times=late)
        self.assertEqual(writer.close(), {"scans": 1, "images": 0, "poses": 0, "points_dropped": 1})
        with self.assertRaises(RuntimeError):
            writer.add(points(), START + STEP)

    def test_after_an_exception_nothing_stays(self):
        path = sample.folder() / "failed"
        with self.assertRaises(KeyError):
            with fovea.DriveWriter(path) as writer:
                writer.add(points(), START)
                raise KeyError
        self.assertFalse(path.exists())
        self.assertFalse(pathlib.Path(f"{path}.partial").exists())

    def test_refuses_what_is_no_frame(self):
        with fovea.DriveWriter(sample.folder() / "refused", cameras={"front": camera()},
                               force=True) as writer:
            writer.add(points(), START)
            for arguments, options in [
                    ((points()[:, :2], START + STEP), {}),
                    ((points(), START), {}),
                    ((points(), START + STEP), {"times": np.zeros(3)}),
                    ((points(), START + STEP), {"rings": np.full(50, 70000)}),
                    ((points(), START + STEP), {"image_stamps": {"rear": START}}),
                    ((points(), START + STEP), {"T_world_lidar": np.zeros((4, 4))}),
                    ((points(), START + STEP), {"images": {"rear": np.zeros((48, 64, 3), np.uint8)}}),
                    ((points(), START + STEP), {"images": {"front": np.zeros((4, 64, 3), np.uint8)}}),
                    ((points(), START + STEP), {"images": {"front": np.zeros((48, 64, 2), np.uint8)}})]:
                with self.assertRaises(ValueError, msg=str(options)):
                    writer.add(*arguments, **options)
        for changes in [{"distortion_model": "mei"}, {"D": [1.0]}, {"width": 0}, {"K": np.eye(3) * np.nan}]:
            with self.assertRaises(ValueError, msg=str(changes)):
                camera(**changes)

    def test_the_example(self):
        folder = sample.folder() / "data_set"
        folder.mkdir()
        frame = next(iter(fovea.Drive(sample.drive())))
        np.savetxt(folder / "K.txt", K)
        np.savetxt(folder / "T_lidar_cam.txt", np.eye(4))
        np.savetxt(folder / "stamps.txt", [START, START + STEP], fmt="%d")
        np.savetxt(folder / "poses.txt", [pose(0)[:3].ravel(), pose(1)[:3].ravel()])
        cloud = np.column_stack([frame.points, np.zeros(len(frame.points))]).astype(np.float32)
        helper = sample.folder() / "images"
        with fovea.DriveWriter(helper, cameras={"front": camera()}) as writer:
            for number in range(2):
                cloud.tofile(folder / f"{number}.bin")
                writer.add(points(), START + number * STEP,
                           images={"front": np.full((48, 64, 3), 90, np.uint8)})
        for number, image in enumerate(sorted((helper / "images" / "front").glob("*.png"))):
            image.rename(folder / f"{number}.png")
        run = run_python(EXAMPLES / "write_drive.py", folder, sample.folder() / "adapted")
        self.assertEqual(run.returncode, 0, run.stdout)
        self.assertIn("2 frames, camera 0", run.stdout)


if __name__ == "__main__":
    unittest.main()
