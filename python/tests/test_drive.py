"""fovea.Drive and fovea.Frame: frames by number, images by camera, poses by navigation."""
import shutil
import unittest
import warnings

import fovea
import numpy as np

import sample


class Frames(unittest.TestCase):
    def test_are_found_by_their_numbers(self):
        drive = fovea.Drive(sample.drive(), frames=(2, 4))
        self.assertEqual(len(drive), 2)
        self.assertEqual(drive.frames, range(2, 4))
        self.assertEqual([drive[2].index, drive[np.int64(3)].index], [2, 3])
        np.testing.assert_array_equal(drive[3].points, drive.load(3).points)
        for number in 0, 1, 4, -1, -2:
            with self.assertRaises(IndexError):
                drive[number]
        with self.assertRaises(TypeError):
            drive[2:3]

    def test_that_cannot_be_used_are_an_error(self):
        with self.assertRaises(fovea.InputError):
            fovea.Drive(sample.drive())[sample.WITHOUT_SCAN]

    def test_a_drive_that_has_vanished_ends_the_iteration(self):
        path = sample.folder() / "vanishing"
        shutil.copytree(sample.drive(), path)
        drive = fovea.Drive(path, use_images=False)
        shutil.rmtree(path)
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            with self.assertRaises(fovea.InputError):
                list(drive)

    def test_have_a_readable_form(self):
        drive = fovea.Drive(sample.drive(), frames=(0, 2), cameras=[3, 2])
        self.assertRegex(repr(drive), r"<fovea\.Drive '.*', kitti-raw, frames 0 to 1, "
                                      r"cameras \[3, 2\]>")
        self.assertRegex(repr(drive[1]), r"<fovea\.Frame 1, \d+ points, 2 cameras>")
        self.assertRegex(repr(drive.cameras[0]), r"<fovea\.Camera 3, \d+ x \d+>")


class ImagesTest(unittest.TestCase):
    def setUp(self):
        self.drive = fovea.Drive(sample.drive(), frames=(0, 2), cameras=[3, 2])

    def test_are_found_by_the_number_of_the_camera(self):
        images = self.drive[0].images
        self.assertEqual(list(images), [3, 2])
        for number in 2, 3:
            alone = fovea.Drive(sample.drive(), cameras=[number])
            np.testing.assert_array_equal(images[number], alone[0].images[number])
        self.assertTrue((images[2] != images[3]).any())
        self.assertIsNone(images.get(7))
        with self.assertRaises(KeyError):
            images[7]

    def test_a_place_in_the_list_of_cameras_warns(self):
        images = self.drive[0].images
        with self.assertWarnsRegex(DeprecationWarning, r"use images\[3\], not images\[0\]"):
            first = images[0]
        np.testing.assert_array_equal(first, images[3])
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            images[2]


class Navigation(unittest.TestCase):
    def test_gives_poses_and_motions(self):
        drive = fovea.Drive(sample.drive(), frames=(0, 2), use_images=False)
        first, second = drive[0], drive[1]
        elapsed = (second.stamp - first.stamp) / 1e9
        step = np.linalg.inv(first.T_local_lidar) @ second.T_local_lidar
        np.testing.assert_allclose(step[:3, 3], elapsed * first.motion.velocity[3:], atol=0.05)
        self.assertGreater(step[0, 3], 0.3)

    def test_may_be_missing(self):
        frame = fovea.Drive(sample.drive(), use_images=False, use_navigation=False)[0]
        self.assertIsNone(frame.T_local_lidar)
        self.assertIsNone(frame.motion)


class MapDrive(unittest.TestCase):
    def test_uses_the_frames_and_cameras_of_a_drive(self):
        drive = fovea.Drive(sample.drive(), frames=(1, 3), cameras=[3])
        output = sample.folder() / "of_drive.fovea"
        summary = fovea.map_drive(drive, output, settings={"surface.spacing_m": 0.2}, force=True)
        self.assertEqual(summary["frames"], 2)
        self.assertEqual(fovea.Map(output).meta["cameras"], "3")


class CameraTest(unittest.TestCase):
    def test_projects_points(self):
        camera = fovea.Camera(100, 80, [[50, 0, 40], [0, 60, 30], [0, 0, 1]])
        pixels = camera.project([[1, 2, 4], [0, 0, 0.05], [0, 0, -1]])
        np.testing.assert_allclose(pixels[0], [52.5, 60])
        self.assertTrue(np.isnan(pixels[1:]).all())
        np.testing.assert_array_equal(camera.T_cam_lidar, np.eye(4))

    def test_stands_where_it_took_the_image(self):
        drive = fovea.Drive(sample.drive(), frames=(0, 1))
        camera, motion = drive.cameras[0], drive[0].motion
        np.testing.assert_array_equal(camera.at_image(None).T_cam_lidar, camera.T_cam_lidar)
        moved = camera.at_image(motion).T_cam_lidar @ np.linalg.inv(camera.T_cam_lidar)
        np.testing.assert_allclose(np.linalg.norm(moved[:3, 3]),
                                   abs(camera.image_delay) * motion.velocity[3], atol=0.02)

    def test_refuses_what_is_no_camera(self):
        for K in np.eye(3) * np.nan, np.diag([0, 1, 1]), np.ones((3, 3)), np.diag([1, 1, 2]):
            with self.assertRaises(ValueError):
                fovea.Camera(10, 10, K)
        for size in (0, 10), (10, -1), (60000, 60000):
            with self.assertRaises(ValueError):
                fovea.Camera(*size, np.eye(3))
        with self.assertRaises(ValueError):
            fovea.Camera(10, 10, np.eye(3), 2 * np.eye(4))


if __name__ == "__main__":
    unittest.main()
