"""fovea.LiveMapper: maps of data that threads send."""
import unittest

import fovea
import numpy as np

import live_sample
import sample


def poses_of(path):
    return [frame.T_local_lidar for frame in fovea.Map(path).frames]


class LiveMapperTest(unittest.TestCase):
    def test_makes_the_map_of_the_drive(self):
        file, live = (sample.folder() / name for name in ("live_file.fovea", "live.fovea"))
        of_file = fovea.map_drive(live_sample.drive(), file, settings=sample.SETTINGS, force=True)
        poses = []
        with live_sample.mapper(live.name, on_pose=poses.append) as mapper:
            live_sample.feed(mapper)
        summary = mapper.close()
        self.assertEqual(summary["frames"], live_sample.FRAMES)
        self.assertEqual(summary["points"], of_file["points"])
        self.assertEqual(summary["textures_skipped"], 0)
        self.assertEqual(summary["live"]["scans"], live_sample.FRAMES)
        self.assertEqual(summary["live"]["images"], live_sample.FRAMES)
        self.assertEqual(summary["live"]["poses"], live_sample.FRAMES)
        self.assertEqual(summary["live"], mapper.figures)
        np.testing.assert_array_equal(poses_of(live), poses_of(file))
        np.testing.assert_array_equal(fovea.Map(live).points().position,
                                      fovea.Map(file).points().position)
        np.testing.assert_array_equal(fovea.Map(live).points().color,
                                      fovea.Map(file).points().color)
        self.assertEqual([pose.index for pose in poses], list(range(live_sample.FRAMES)))
        self.assertEqual([pose.stamp for pose in poses],
                         [frame.stamp for frame in live_sample.frames()])
        self.assertEqual({pose.state for pose in poses}, {"tracked"})
        self.assertIsNone(poses[0].covariance)
        self.assertEqual(poses[-1].covariance.shape, (6, 6))
        np.testing.assert_allclose([pose.T_local_lidar for pose in poses], poses_of(live),
                                   atol=0.1)

    def test_a_later_mapper_continues_the_map(self):
        before = 8
        with live_sample.mapper("continued.fovea") as mapper:
            live_sample.feed(mapper, 0, before)
        indices = []
        with live_sample.mapper("continued.fovea", resume=True, force=False,
                                on_pose=lambda pose: indices.append(pose.index)) as mapper:
            live_sample.feed(mapper, before)
        self.assertEqual(indices, list(range(before, live_sample.FRAMES)))
        self.assertEqual(mapper.close()["frames"], live_sample.FRAMES)
        self.assertEqual(len(fovea.Map(sample.folder() / "continued.fovea").frames),
                         live_sample.FRAMES)

    def test_the_frames_are_recorded(self):
        path = sample.folder() / "live_recorded"
        with live_sample.mapper("recorded.fovea", record=path) as mapper:
            live_sample.feed(mapper, 0, 6)
        recorded = list(fovea.Drive(path))
        self.assertEqual([frame.stamp for frame in recorded],
                         [frame.stamp for frame in live_sample.frames()[:6]])
        for frame, sent in zip(recorded, live_sample.frames()):
            np.testing.assert_array_equal(frame.points, sent.points)
            np.testing.assert_array_equal(frame.images[0], sent.images[2])
        with self.assertRaises(fovea.OutputError):
            live_sample.mapper("recorded.fovea", record=path)

    def test_what_cannot_be_used_is_counted(self):
        frame = live_sample.frames()[1]
        with live_sample.mapper("counted.fovea") as mapper:
            live_sample.feed(mapper, 0, 4)
            mapper.add_scan(frame.stamp, frame.points)
            mapper.add_pose(frame.stamp, np.eye(4))
            mapper.add_image(live_sample.CAMERA, frame.stamp, frame.images[2])
        summary = mapper.close()
        self.assertEqual(summary["frames"], 4)
        live = summary["live"]
        self.assertEqual(live["scans_out_of_order"], 1)
        self.assertEqual(live["poses_late"], 1)
        self.assertEqual(live["images"], 5)

    def test_all_kinds_of_data_and_encoded_images(self):
        toml = (live_sample.simulated() / "drive.toml").read_text()
        toml += "\n[imu]\nT_lidar_imu = {translation = [0, 0, 0], rotation = [0, 0, 0, 1]}\n"
        files = sorted((live_sample.simulated() / "images" / live_sample.CAMERA).glob("*.png"))
        with fovea.LiveMapper(toml, sample.folder() / "all.fovea", every_frame=True, max_wait=60,
                              force=True, settings=sample.SETTINGS) as mapper:
            for frame, file in zip(live_sample.frames()[:5], files):
                stamp = frame.stamp
                mapper.add_position(stamp, 49.0, 8.4 + 1e-6 * frame.index, 110, accuracy=0.02,
                                    roll_pitch_yaw=[0, 0, 0.1])
                mapper.add_imu(stamp, [0, 0, 0.1], [0, 0, 9.8], R_enu_imu=np.eye(3))
                mapper.add_wheel_speed(stamp, 8.0)
                mapper.add_image(live_sample.CAMERA, stamp, file.read_bytes(), exposure=0.01)
                rows = np.column_stack([frame.points, frame.intensity])
                mapper.add_scan(stamp, rows, times=frame.time, rings=np.zeros(len(rows), int))
        summary = mapper.close()
        self.assertEqual(summary["frames"], 5)
        self.assertEqual(summary["images_missing"], {})
        self.assertEqual(summary["live"]["poses"], 15)

    def test_no_image_or_pose_is_needed(self):
        with live_sample.mapper("scans.fovea", expects_navigation=False, max_wait=0) as mapper:
            live_sample.sensors(mapper, 0, 3)[0]()
            self.assertIn("scans", mapper.missing)
        self.assertEqual(len(fovea.Map(sample.folder() / "scans.fovea").frames), 3)


if __name__ == "__main__":
    unittest.main()
