#include "fovea/mapping/fusion/loop_closure.h"

#include <gtest/gtest.h>

#include <cmath>

#include "fovea/core/random.h"

namespace fovea::loop_closure_test {

/// Scan from `T_place_lidar`: walls and poles on flat ground, at positions that depend on the
/// number of the place.
std::vector<Eigen::Vector3f> scan_of(int place, const RigidMotion& T_place_lidar,
                                     int objects = 40) {
  std::vector<Eigen::Vector3f> points;
  const RigidMotion T = T_place_lidar.inverse();
  const auto add = [&](double x, double y, double z) {
    points.push_back((T * Eigen::Vector3d(x, y, z)).cast<float>());
  };
  for (int object = 0; object < objects; ++object) {
    Random random = Random::of_item(3, std::uint64_t(place), std::uint64_t(object));
    const double x = random.uniform(-35, 35), y = random.uniform(-35, 35);
    const double heading = random.uniform(0, 3), length = random.uniform(0.5, 4);
    for (double s = -length; s < length; s += 0.2) {
      for (double z = -1.6; z < 2; z += 0.2) {
        add(x + s * std::cos(heading), y + s * std::sin(heading), z);
      }
    }
  }
  for (double x = -30; x < 30; x += 0.8) {
    for (double y = -30; y < 30; y += 0.8) add(x, y, -1.73);
  }
  return points;
}

RigidMotion pose(double x, double y, double yaw) {
  RigidMotion T(Eigen::Translation3d(x, y, 0));
  T.rotate(Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()));
  return T;
}

class LoopCloserTest : public testing::Test {
 protected:
  LoopCloserTest() {
    for (int place = 0; place < 3; ++place) {
      closer_.add(std::size_t(place), scan_of(place, first_), first_);
    }
  }
  const RigidMotion first_ = pose(1, 2, 0.1), again_ = pose(3, -1, 3.0);
  LoopCloser closer_{RegistrationOptions{}};
};

TEST_F(LoopCloserTest, FindsThePlaceFromAPoorGuessAndTheOtherWay) {
  const auto closure =
      closer_.find(scan_of(1, again_), {{1, again_ * pose(1.5, -1, 0.06), /*path=*/500}});
  ASSERT_TRUE(closure);
  EXPECT_EQ(closure->submap, 1u);
  EXPECT_LT((closure->T_submap_lidar.translation() - again_.translation()).norm(), 0.05);
  EXPECT_LT(rotation_angle(closure->T_submap_lidar.linear().transpose() * again_.linear()), 0.005);
}

TEST_F(LoopCloserTest, AnotherPlaceIsRefused) {
  EXPECT_FALSE(closer_.find(scan_of(2, again_), {{1, again_, 500}}));
  EXPECT_FALSE(closer_.find(scan_of(7, again_), {{0, again_, 500}, {1, again_, 500}}));
}

TEST_F(LoopCloserTest, TheNextBestCandidateHasItsTurn) {
  const auto closure = closer_.find(
      scan_of(1, again_), {{1, again_ * pose(2, 0, 0), 500}, {0, again_ * pose(-2, 3, 0), 500}});
  ASSERT_TRUE(closure);
  EXPECT_EQ(closure->submap, 1u);
}

TEST_F(LoopCloserTest, GroundAloneIsNoPlace) {
  closer_.add(5, scan_of(0, first_, /*objects=*/0), first_);
  EXPECT_FALSE(closer_.find(scan_of(0, again_, 0), {{5, again_, 500}}));
}

TEST_F(LoopCloserTest, IgnoresRecentAndDistantSubmaps) {
  EXPECT_FALSE(closer_.find(scan_of(1, again_), {{1, again_, /*path=*/20}}));
  EXPECT_FALSE(closer_.find(scan_of(1, again_), {{1, again_ * pose(40, 0, 0), 500}}));
  EXPECT_FALSE(closer_.find(scan_of(1, again_), {{9, again_, 500}}));  // not there
  EXPECT_FALSE(closer_.find({}, {{1, again_, 500}}));
}

}  // namespace fovea::loop_closure_test
