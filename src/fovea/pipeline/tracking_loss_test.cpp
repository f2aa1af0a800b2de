// Scans far from their predicted poses, without navigation.
#include <gtest/gtest.h>

#include "fovea/pipeline/mapper_test_support.h"

namespace fovea::tracking_loss_test {

/// A drive through the town at 1 m a frame, without navigation.
SyntheticDrive town_drive(int frames) {
  SyntheticDrive drive(town_scene(), frames, 1.0);
  drive.beams = 24;
  drive.columns = 360;
  drive.editable_info().navigation.reset();
  return drive;
}

MapperOptions options() {
  MapperOptions options;
  options.fusion.loop_closure = false;
  return options;
}

double position_error(const SyntheticDrive& drive, const FrameRecord& record) {
  const auto index = static_cast<std::size_t>(record.index);
  const RigidMotion truth = drive.T_local_lidar[0].inverse() * drive.T_local_lidar[index];
  return (record.T_odom_lidar.translation() - truth.translation()).norm();
}

TEST(TrackingLoss, AScanFarFromItsFirstGuessIsFoundAgain) {
  SyntheticDrive drive = town_drive(10);
  // 7 m behind the prediction by constant velocity, then onwards.
  for (std::size_t i = 7; i < 10; ++i) drive.T_local_lidar[i] = drive.T_local_lidar[i - 7];
  Mapper mapper(drive.info(), options(), PoseSource::kRefine);
  const std::vector<FrameRecord> records = map_frames(mapper, drive, 0, 10);
  EXPECT_NE(records[7].note.find("found again"), std::string::npos) << records[7].note;
  // The figures are those of the search, not of the registration before it.
  EXPECT_NEAR(records[7].figures.at("correction_translation"), 7, 1);
  for (const FrameRecord& record : records) {
    EXPECT_FALSE(record.has("registration_lost")) << record.index;
    EXPECT_LT(position_error(drive, record), 0.05) << record.index;
  }
}

/// A frame with a scan of a round hall, which fits neither the town nor another hall.
Frame frame_in_a_hall(const SyntheticDrive& drive, int index) {
  Frame frame = std::get<Frame>(drive.load(index));
  const float radius = 14 + 4 * static_cast<float>(index - 6);
  for (Eigen::Vector3f& p : frame.scan.position) p *= radius / p.norm();
  return frame;
}

TEST(TrackingLoss, AScanWithoutAFitIsReported) {
  const SyntheticDrive drive = town_drive(8);
  Mapper mapper(drive.info(), options(), PoseSource::kRefine);
  map_frames(mapper, drive, 0, 6);
  const FrameRecord lost = record_of(mapper.process(frame_in_a_hall(drive, 6)));
  EXPECT_TRUE(lost.has("registration_lost"));
  EXPECT_NE(lost.note.find("fits nowhere"), std::string::npos) << lost.note;
  // A lost scan is no target: the next scan has the right pose.
  const FrameRecord next = record_of(mapper.process(std::get<Frame>(drive.load(7))));
  EXPECT_FALSE(next.has("registration_lost"));
  EXPECT_LT(position_error(drive, next), 0.05);
}

TEST(TrackingLoss, ADriveThatStaysLostStartsAgain) {
  const SyntheticDrive drive = town_drive(10);
  Mapper mapper(drive.info(), options(), PoseSource::kRefine);
  map_frames(mapper, drive, 0, 6);
  for (int i = 6; i < 10; ++i) {
    const FrameRecord lost = record_of(mapper.process(frame_in_a_hall(drive, i)));
    EXPECT_TRUE(lost.has("registration_lost")) << i;
  }
  // After that many lost scans, the next one becomes a target, at any pose: later ones fit it.
  SyntheticDrive elsewhere(town_scene(), 14, 0.6);
  elsewhere.beams = 24;
  elsewhere.columns = 360;
  std::vector<FrameRecord> records;
  for (int i = 10; i < 14; ++i) {
    records.push_back(record_of(mapper.process(std::get<Frame>(elsewhere.load(i)))));
  }
  EXPECT_FALSE(records[3].has("registration_lost"));
  const RigidMotion moved = records[2].T_odom_lidar.inverse() * records[3].T_odom_lidar;
  EXPECT_NEAR(moved.translation().x(), 0.6, 0.05);
}

}  // namespace fovea::tracking_loss_test
