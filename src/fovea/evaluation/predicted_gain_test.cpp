#include "fovea/evaluation/predicted_gain.h"

#include <gtest/gtest.h>

#include <cmath>

namespace fovea::predicted_gain_test {

FrameRecord frame_of(int index, std::optional<double> log2_gain) {
  FrameRecord record;
  record.index = index;
  ViewRecord view;
  view.camera = 2;
  if (log2_gain) view.log2_gain = Eigen::Vector3d(*log2_gain, 0, 1);
  record.views = {view};
  return record;
}

TEST(PredictedGain, IsTheGeometricMeanOfTheNeighbors) {
  const std::vector<FrameRecord> frames = {frame_of(0, 5), frame_of(1, 1), frame_of(2, {}),
                                           frame_of(3, -2), frame_of(4, 7)};
  const Eigen::Vector3f gain = *predicted_gain(frames, 2, 2);
  EXPECT_FLOAT_EQ(gain.x(), std::exp2(-0.5f));
  EXPECT_FLOAT_EQ(gain.y(), 1);
  EXPECT_FLOAT_EQ(gain.z(), 2);
  // A frame's own gain does not count.
  EXPECT_FLOAT_EQ(predicted_gain(frames, 3, 2)->x(), std::exp2(4.0f));
}

TEST(PredictedGain, AtAnEndIsThatOfTheOneNeighbor) {
  const std::vector<FrameRecord> frames = {frame_of(0, {}), frame_of(1, 1), frame_of(2, {})};
  EXPECT_FLOAT_EQ(predicted_gain(frames, 0, 2)->x(), 2);
  EXPECT_FLOAT_EQ(predicted_gain(frames, 2, 2)->x(), 2);
}

TEST(PredictedGain, IsUnknownWithoutGainsOfTheCamera) {
  EXPECT_FALSE(predicted_gain({frame_of(0, 1)}, 1, 3));
  EXPECT_FALSE(predicted_gain({frame_of(0, {})}, 1, 2));
  EXPECT_FALSE(predicted_gain({}, 1, 2));
}

}  // namespace fovea::predicted_gain_test
