#include "fovea/localization/place_candidates.h"

#include <gtest/gtest.h>

namespace fovea::place_candidates_test {

std::vector<FrameRecord> frames_along_x(int count) {
  std::vector<FrameRecord> frames(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) {
    frames[std::size_t(i)].index = i;
    frames[std::size_t(i)].T_local_lidar.translation().x() = i;
  }
  frames[0].status = FrameStatus::kSkipped;  // its pose says nothing
  return frames;
}

TEST(PlaceCandidates, NearestFirstAndEachOnceBeforeAnyTwice) {
  PlaceCandidates candidates;
  candidates.add(frames_along_x(14));  // places at 1, 5, 9, 13, either way round
  EXPECT_EQ(candidates.first().translation().x(), 1);
  const Eigen::Vector3d near(8, 0, 0);
  std::vector<double> forward, backward;
  for (int i = 0; i < 8; ++i) {
    const RigidMotion T = candidates.next(near);
    (T.linear()(0, 0) > 0 ? forward : backward).push_back(T.translation().x());
  }
  EXPECT_EQ(forward, (std::vector<double>{9, 5, 13, 1}));
  EXPECT_EQ(backward, (std::vector<double>{9, 5, 13, 1}));
  EXPECT_EQ(candidates.next(near).translation().x(), 9);
  EXPECT_EQ(candidates.next(near).translation().x(), 5);
  candidates.restart();
  EXPECT_EQ(candidates.next({0, 0, 0}).translation().x(), 1);
}

TEST(PlaceCandidates, AMapOfSkippedFramesHasNone) {
  PlaceCandidates candidates;
  EXPECT_TRUE(candidates.empty());
  candidates.add(frames_along_x(1));
  EXPECT_TRUE(candidates.empty());
  candidates.add(frames_along_x(2));
  EXPECT_FALSE(candidates.empty());
}

}  // namespace fovea::place_candidates_test
