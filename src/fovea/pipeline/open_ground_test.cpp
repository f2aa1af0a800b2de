// Only ground: the scan determines neither the translation of the vehicle nor its yaw.
#include <gtest/gtest.h>

#include "fovea/pipeline/mapper_test_support.h"

namespace fovea::open_ground_test {

SyntheticDrive ground_drive(int frames, int beams) {
  const BoxScene ground{{{{-100, -100, -2.7}, {100, 100, -1.7}}}};
  SyntheticDrive drive(ground, frames, 1.0);
  drive.beams = beams;
  drive.columns = 360;
  drive.editable_info().navigation_accuracy.assign(std::size_t(frames), 0.05);
  return drive;
}

TEST(OpenGround, NavigationDecidesTheDirectionsThatTheScanLeavesOpen) {
  for (const int beams : {48, 16, 8}) {
    const SyntheticDrive drive = ground_drive(12, beams);
    Mapper mapper(drive.info(), {}, PoseSource::kRefine);
    for (const FrameRecord& record : map_frames(mapper, drive, 0, 12)) {
      const RigidMotion& truth = drive.T_local_lidar[std::size_t(record.index)];
      const RigidMotion error = truth.inverse() * record.T_odom_lidar;
      EXPECT_LT(error.translation().norm(), 0.02) << beams << " beams, frame " << record.index;
      EXPECT_LT(rotation_angle(error.linear()), 0.002) << beams << " beams, frame " << record.index;
    }
  }
}

}  // namespace fovea::open_ground_test
