#include "fovea/pipeline/calibration_check.h"

#include <gtest/gtest.h>

#include "fovea/core/angle.h"

namespace fovea::calibration_check_test {

DriveInfo drive_of(int frames) {
  DriveInfo drive;
  drive.begin = 100;
  drive.end = 100 + frames;
  drive.calibration.cameras.resize(2);
  drive.calibration.cameras[0].index = 2;
  drive.calibration.cameras[1].index = 3;
  return drive;
}

TEST(CalibrationCheck, UsesFewFramesSpreadOverTheDrive) {
  for (const int frames : {1, 7, 40, 400, 10000}) {
    const DriveInfo drive = drive_of(frames);
    CalibrationCheck check(drive, true, /*is_live=*/false);
    std::vector<int> looked_at;
    for (int index = drive.begin; index < drive.end; ++index) {
      if (!check.is_due(index)) continue;
      Frame frame;
      frame.index = index;
      frame.images.resize(2);
      check.add_edges(frame, {});
      looked_at.push_back(index);
    }
    EXPECT_LE(looked_at.size(), std::size_t(CalibrationCheck::kFrames));
    if (frames < 40) continue;
    EXPECT_GE(looked_at.size(), std::size_t(CalibrationCheck::kFrames - 1));
    EXPECT_GT(looked_at.back(), drive.end - frames / 8);
    // Frames without edges do not count.
    const auto found = check.estimate().cameras;
    ASSERT_EQ(found.size(), 2u);
    EXPECT_EQ(found[1].camera, 3);
    EXPECT_FALSE(found[1].estimate.rotation_observable() || found[1].estimate.delay_observable());
  }
}

TEST(DriveCalibration, CorrectsEachCameraByItsOwnEstimate) {
  const DriveInfo drive = drive_of(10);
  DriveCalibration found;
  found.cameras.resize(2);
  found.cameras[1].estimate.correction.rotation.z() = 1 * kDegree;
  found.cameras[1].estimate.correction.delay = 0.02;
  const Calibration right = corrected(drive, found).calibration;
  EXPECT_TRUE(right.cameras[0].T_cam_lidar.isApprox(RigidMotion::Identity(), 0));
  EXPECT_EQ(right.cameras[0].image_delay, 0);
  EXPECT_NEAR(log_se3(right.cameras[1].T_cam_lidar)[2], 1 * kDegree, 1e-12);
  EXPECT_EQ(right.cameras[1].image_delay, 0.02);
}

}  // namespace fovea::calibration_check_test
