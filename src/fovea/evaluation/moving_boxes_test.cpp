#include "fovea/evaluation/moving_boxes.h"

#include <gtest/gtest.h>

namespace fovea::moving_boxes_test {

/// The vehicle drives 1 m a frame along x.
std::vector<FrameRecord> frames() {
  std::vector<FrameRecord> frames(10);
  for (int i = 0; i < 10; ++i) {
    frames[i].index = i;
    frames[i].T_local_lidar = Eigen::Translation3d(i, 0, 0) * RigidMotion::Identity();
  }
  return frames;
}

/// A car at frames 2-7, at `first` and moving by `step` a frame, both in the LiDAR frame.
Tracklet car(const Eigen::Vector3d& first, const Eigen::Vector3d& step) {
  Tracklet car{"Car", {4, 2, 1.5}, 2, {}};
  for (int i = 0; i < 6; ++i) {
    car.T_lidar_box.push_back(Eigen::Translation3d(first + i * step) * RigidMotion::Identity());
  }
  return car;
}

TEST(MovingBoxes, StandStillInTheLocalFrameNotInTheLidars) {
  const Tracklet parked = car({20, 5, -1.7}, {-1, 0, 0}), ahead = car({9, 0, -1.7}, {0, 0, 0});
  const MovingBoxes boxes({parked, ahead}, frames());
  EXPECT_EQ(boxes.labelled(), 2u);
  EXPECT_EQ(boxes.moved(), 1u);
  EXPECT_TRUE(boxes.contain(2, {9, 0, -1}));
  EXPECT_TRUE(boxes.contain(7, {11.05, 0, -1}));
  EXPECT_FALSE(boxes.contain(7, {11.2, 0, -1}));
  EXPECT_FALSE(boxes.contain(8, {9, 0, -1}));   // not labelled any more
  EXPECT_FALSE(boxes.contain(2, {20, 5, -1}));  // parked
}

TEST(MovingBoxes, LabelsMayWaver) {
  EXPECT_EQ(MovingBoxes({car({20, 5, -1.7}, {-0.95, 0, 0})}, frames()).moved(), 0u);  // 0.25 m
  EXPECT_EQ(MovingBoxes({car({20, 5, -1.7}, {-0.85, 0, 0})}, frames()).moved(), 1u);  // 0.75 m
  std::vector<FrameRecord> skipped = frames();
  for (int i = 4; i < 10; ++i) skipped[i].status = FrameStatus::kSkipped;
  EXPECT_EQ(MovingBoxes({car({20, 5, -1.7}, {-0.85, 0, 0})}, skipped).moved(), 0u);
}

}  // namespace fovea::moving_boxes_test
