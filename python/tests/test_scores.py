"""fovea.evaluate and fovea.Localizer."""
import json
import unittest

import fovea
import numpy as np

import sample


class EvaluateTest(unittest.TestCase):
    def test_gives_what_the_program_writes(self):
        report = sample.folder() / "report.json"
        for protocol in ["held-out", "in-sample", "truth"]:
            sample.run("evaluate", sample.map_file(), sample.drive(), "--protocol", protocol,
                       "--json", report)
            self.assertEqual(fovea.evaluate(fovea.Map(sample.map_file()), sample.drive(), protocol),
                             json.loads(report.read_text()))

    def test_errors(self):
        with self.assertRaises(fovea.ConfigError):
            fovea.evaluate(sample.map_file(), sample.drive(), "by-heart")
        with self.assertRaises(fovea.InputError):
            fovea.evaluate(sample.map_file(), sample.folder() / "none")


class LocalizerTest(unittest.TestCase):
    def test_finds_the_drive_in_its_own_map(self):
        drive = fovea.Drive(sample.drive(), frames=(0, 4), use_images=False)
        localizer = fovea.Localizer(fovea.Map(sample.map_file()), drive)
        refined = [frame.T_local_lidar for frame in fovea.Map(sample.map_file()).frames]
        for frame in drive:
            place = localizer.localize(frame)
            self.assertEqual(place.state, "localized")
            self.assertEqual(place.index, frame.index)
            np.testing.assert_allclose(place.T_local_lidar, refined[frame.index], atol=0.1)
            self.assertEqual(place.covariance.shape, (6, 6))
            self.assertTrue(np.all(np.linalg.eigvalsh(place.covariance) > 0))
            self.assertTrue(0 < place.health <= 1)

    def test_takes_a_first_guess(self):
        drive = fovea.Drive(sample.drive(), frames=(0, 1), use_images=False)
        guess = fovea.Map(sample.map_file()).frames[0].T_local_lidar
        guess[0, 3] += 0.5
        localizer = fovea.Localizer(sample.map_file(), drive, use_navigation=False,
                                    T_local_lidar=guess)
        self.assertEqual(localizer.localize(drive.load(0)).state, "localized")

    def test_a_pose_is_checked_as_one_of_a_file_is(self):
        drive = fovea.Drive(sample.drive(), frames=(0, 1), use_images=False)
        few_digits = np.round(fovea.Map(sample.map_file()).frames[0].T_local_lidar, 4)
        localizer = fovea.Localizer(sample.map_file(), drive, use_navigation=False,
                                    T_local_lidar=few_digits)
        self.assertEqual(localizer.localize(drive.load(0)).state, "localized")
        far, unknown, moved = np.eye(4), np.eye(4), np.eye(4)
        far[0, 3] = 1e8
        unknown[1, 3] = np.nan
        moved[3, 0] = 1
        for pose, problem in [(np.diag([2, 2, 2, 1]), "no rotation"), (far, "10000 km"),
                              (unknown, "not finite"), (moved, "last row"),
                              (np.eye(3), "shape")]:
            with self.assertRaisesRegex(ValueError, problem):
                fovea.Localizer(sample.map_file(), drive, T_local_lidar=pose)


if __name__ == "__main__":
    unittest.main()
