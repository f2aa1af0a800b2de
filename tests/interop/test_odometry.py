"""KISS-ICP and small_gicp find the poses that Fovea finds. The table of the comparison is printed."""
import os
import pathlib
import unittest

import compare_odometry
import sample

NEARBY = pathlib.Path(__file__).resolve().parents[3] / "shared/data/kitti/2011_09_26/2011_09_26_drive_0009_sync"
KITTI = pathlib.Path(os.environ.get("FOVEA_KITTI_SAMPLE", NEARBY))
WITHIN_CM = {"truth": 10, "GPS/INS": 30}
OURS_WITHIN_CM = {"truth": 1, "GPS/INS": 15}


class OdometryTest(unittest.TestCase):
    def test_poses_agree(self):
        drive = KITTI if KITTI.exists() else sample.drive()
        source, figures = compare_odometry.compare(drive, runs=1)
        compare_odometry.print_table(drive, 1, source, figures)
        for name, one in figures.items():
            with self.subTest(name):
                within = OURS_WITHIN_CM if name.startswith("Fovea") else WITHIN_CM
                self.assertLess(100 * one.aligned_rms_m, within[source])


if __name__ == "__main__":
    unittest.main()
