#include "fovea/mapping/registration/keyframes.h"

#include <gtest/gtest.h>

#include <vector>

namespace fovea::keyframes_test {

RigidMotion at(double x, double yaw = 0) {
  return Eigen::Translation3d(x, 0, 0) * Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ());
}

std::vector<double> chosen(Keyframes keyframes, const std::vector<double>& positions) {
  std::vector<double> result;
  for (const double x : positions) {
    if (keyframes.add_if_due(at(x), 1)) result.push_back(x);
  }
  return result;
}

TEST(Keyframes, AreFarFromTheLastOne) {
  const Keyframes keyframes({1.5, 0.04});
  EXPECT_EQ(chosen(keyframes, {0, 1, 2, 3, 4, 5}), (std::vector<double>{0, 2, 4}));
  EXPECT_EQ(chosen(keyframes, {7, 7, 7, 7}), std::vector<double>{7});
  // Distances are straight, not along the path.
  EXPECT_EQ(chosen(keyframes, {0, 1, 0, -1, 0, 1, 2}), (std::vector<double>{0, 2}));
  EXPECT_EQ(chosen(Keyframes({0, 0.04}), {7, 7, 7}), (std::vector<double>{7, 7, 7}));
}

TEST(Keyframes, AreTurnedFromTheLastOne) {
  Keyframes keyframes({1.5, 0.04});
  EXPECT_TRUE(keyframes.add_if_due(at(0), 1));
  EXPECT_FALSE(keyframes.add_if_due(at(0.1, 0.03), 1));
  EXPECT_TRUE(keyframes.add_if_due(at(0.2, -0.05), 1));
  EXPECT_FALSE(keyframes.add_if_due(at(0.2, -0.02), 1));
}

TEST(Keyframes, IncludeScansOfLowOverlap) {
  Keyframes keyframes({1.5, 0.04, 0.9});
  EXPECT_TRUE(keyframes.add_if_due(at(0), 1));
  EXPECT_FALSE(keyframes.add_if_due(at(1), 0.9));
  EXPECT_TRUE(keyframes.add_if_due(at(1), 0.8));
  // Distances count from this keyframe.
  EXPECT_FALSE(keyframes.add_if_due(at(2), 1));
  EXPECT_TRUE(keyframes.add_if_due(at(2.5), 1));
}

}  // namespace fovea::keyframes_test
