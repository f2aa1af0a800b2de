"""evo reads our trajectories, and its errors against the truth are those of `fovea evaluate --truth`."""
import json
import unittest

import numpy as np
from evo.core import metrics, sync
from evo.core.trajectory import PosePath3D, PoseTrajectory3D
from evo.tools import file_interface

import fovea

import sample

TRUTH = sample.drive() / "truth" / "poses.txt"


def statistics(metric: metrics.PE, reference: PosePath3D, estimate: PosePath3D) -> dict[str, float]:
    metric.process_data((reference, estimate))
    return metric.get_all_statistics()


class EvoTest(unittest.TestCase):
    def setUp(self):
        self.frames = fovea.Map(sample.map_file()).frames
        self.poses = np.array([frame.T_local_lidar for frame in self.frames])
        self.truth = file_interface.read_kitti_poses_file(str(TRUTH))
        report = sample.folder() / "truth.json"
        sample.run("evaluate", sample.map_file(), sample.drive(), "--truth", "--json", report)
        self.report = json.loads(report.read_text())

    def test_kitti_poses(self):
        path = file_interface.read_kitti_poses_file(str(sample.export("poses.txt", "--format", "kitti-poses")))
        np.testing.assert_allclose(path.poses_se3, self.poses, atol=1e-9)

    def test_tum(self):
        path = file_interface.read_tum_trajectory_file(str(sample.export("poses.tum")))
        np.testing.assert_allclose(path.poses_se3, self.poses, atol=1e-9)
        np.testing.assert_allclose(path.timestamps, [frame.stamp * 1e-9 for frame in self.frames], atol=1e-6)

    def test_the_motion_from_frame_to_frame(self):
        estimate = file_interface.read_kitti_poses_file(str(sample.export("poses.txt", "--format", "kitti-poses")))
        for relation, key in ((metrics.PoseRelation.translation_part, "pose_relative_m"),
                              (metrics.PoseRelation.rotation_angle_deg, "pose_relative_deg")):
            figures = statistics(metrics.RPE(relation, delta=1, delta_unit=metrics.Unit.frames), self.truth, estimate)
            for figure in ("mean", "rmse", "max"):
                with self.subTest(key=key, figure=figure):
                    self.assertAlmostEqual(figures[figure], self.report[key][figure], delta=1e-5)

    def test_the_absolute_error(self):
        estimate = file_interface.read_tum_trajectory_file(str(sample.export("poses.tum")))
        stamped = PoseTrajectory3D(poses_se3=self.truth.poses_se3, timestamps=estimate.timestamps)
        reference, estimate = sync.associate_trajectories(stamped, estimate)
        estimate.align(reference)
        figures = statistics(metrics.APE(metrics.PoseRelation.translation_part), reference, estimate)
        # evo minimizes the position error. `fovea evaluate` takes the rotation of the frames, which fits less well.
        ours = self.report["pose_aligned_m"]["rmse"]
        self.assertLess(figures["rmse"], ours + 1e-6)
        self.assertGreater(figures["rmse"], 0.3 * ours)


if __name__ == "__main__":
    unittest.main()
