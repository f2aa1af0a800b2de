#include "fovea/evaluation/predicted_light.h"

#include <gtest/gtest.h>

#include <cmath>

namespace fovea::predicted_light_test {

FrameRecord frame_of(int index, std::optional<double> log2_gain) {
  FrameRecord record;
  record.index = index;
  ViewRecord view;
  view.camera = 2;
  if (log2_gain) view.log2_gain = Eigen::Vector3d(*log2_gain, 0, 1);
  record.views = {view};
  return record;
}

TEST(PredictedLight, IsTheGeometricMeanOfTheNeighbors) {
  const std::vector<FrameRecord> frames = {frame_of(0, 5), frame_of(1, 1), frame_of(2, {}),
                                           frame_of(3, -2), frame_of(4, 7)};
  const LogGain gain = predicted_light(frames, 2, 2)->gain;
  EXPECT_FLOAT_EQ(gain.x(), -0.5f);
  EXPECT_FLOAT_EQ(gain.y(), 0);
  EXPECT_FLOAT_EQ(gain.z(), 1);
  // A frame's own gain does not count.
  EXPECT_FLOAT_EQ(predicted_light(frames, 3, 2)->gain.x(), 4);
}

TEST(PredictedLight, AtAnEndIsThatOfTheOneNeighbor) {
  const std::vector<FrameRecord> frames = {frame_of(0, {}), frame_of(1, 1), frame_of(2, {})};
  EXPECT_FLOAT_EQ(predicted_light(frames, 0, 2)->gain.x(), 1);
  EXPECT_FLOAT_EQ(predicted_light(frames, 2, 2)->gain.x(), 1);
}

TEST(PredictedLight, IsUnknownWithoutGainsOfTheCamera) {
  EXPECT_FALSE(predicted_light({frame_of(0, 1)}, 1, 3));
  EXPECT_FALSE(predicted_light({frame_of(0, {})}, 1, 2));
  EXPECT_FALSE(predicted_light({}, 1, 2));
}

}  // namespace fovea::predicted_light_test
