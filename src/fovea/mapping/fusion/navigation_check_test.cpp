#include "fovea/mapping/fusion/navigation_check.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

namespace fovea::navigation_check_test {

constexpr TimeNs kTenth = kNsPerSecond / 10;
constexpr int kFrames = 100;

RigidMotion at(double x, double y = 0) { return RigidMotion(Eigen::Translation3d(x, y, 0)); }

/// True motion: 1 m a frame along x.
class NavigationCheckTest : public testing::Test {
 protected:
  NavigationCheckTest() {
    for (int i = 0; i < kFrames; ++i) poses_.push_back({i * kTenth, at(i)});
  }
  void start() {
    navigation_ = Trajectory(poses_);
    check_.emplace(&navigation_, accuracy_);
  }
  /// @return frames with a fault
  std::vector<int> drive(int begin, int end) {
    std::vector<int> wrong;
    for (int i = begin; i < end; ++i) {
      if (!check_->observe(i * kTenth, at(i)).empty()) wrong.push_back(i);
    }
    return wrong;
  }
  double deviation(int frame) const { return check_->measurement(0, frame * kTenth)->sigma[3]; }

  std::vector<StampedPose> poses_;
  std::vector<double> accuracy_ = std::vector<double>(kFrames, 0.2);
  Trajectory navigation_;
  std::optional<NavigationCheck> check_;
};

TEST_F(NavigationCheckTest, GoodNavigationCountsByItsAccuracy) {
  accuracy_[50] = 0.7;
  start();
  EXPECT_TRUE(drive(0, kFrames).empty());
  EXPECT_NEAR(deviation(50) / deviation(49), 3.5, 1e-9);
  EXPECT_GT(deviation(49), 0.2);  // consecutive errors are similar
  EXPECT_TRUE(check_->measurement(7, 30 * kTenth)->T_local_node.isApprox(at(30)));
  EXPECT_EQ(check_->measurement(7, 30 * kTenth)->node, 7u);
}

TEST_F(NavigationCheckTest, AJumpCountsUntilNavigationJumpsBack) {
  for (int i = 40; i < 60; ++i) poses_[std::size_t(i)].T_local_body.translation().y() += 5;
  start();
  EXPECT_THAT(drive(0, 50), testing::ElementsAre(40));
  EXPECT_GT(deviation(45), 5);
  EXPECT_THAT(drive(50, kFrames), testing::ElementsAre(60));
  EXPECT_LT(deviation(70), 1);
}

TEST_F(NavigationCheckTest, AJumpIsForgottenAfterAMinute) {
  for (int i = 100; i < 800; ++i) {
    poses_.push_back({i * kTenth, at(i)});
    accuracy_.push_back(0.2);
  }
  for (std::size_t i = 40; i < poses_.size(); ++i) poses_[i].T_local_body.translation().y() += 5;
  start();
  drive(0, 600);
  EXPECT_GT(deviation(600), 5);
  drive(600, 700);
  EXPECT_LT(deviation(699), 1);
}

TEST_F(NavigationCheckTest, FrozenNavigationCountsLessAndLess) {
  for (int i = 40; i < 60; ++i) poses_[std::size_t(i)].T_local_body = at(39);
  start();
  EXPECT_EQ(drive(0, 50).size(), 10u);
  EXPECT_NEAR(deviation(49), 3 * 0.2 + 10, 1e-6);
  EXPECT_EQ(drive(50, kFrames).size(), 11u);  // ten more, and the return
  EXPECT_NEAR(deviation(70), 3 * 0.2, 1e-6);
}

TEST_F(NavigationCheckTest, AnOutageIsMeasuredByThePathAcrossIt) {
  poses_.erase(poses_.begin() + 20, poses_.begin() + 60);
  for (std::size_t i = 20; i < poses_.size(); ++i) poses_[i].T_local_body.translation().y() += 2;
  accuracy_.resize(poses_.size());
  start();
  // The first record after the outage is of frame 60; its velocity covers the two frames before.
  EXPECT_THAT(drive(0, kFrames), testing::ElementsAre(58));
  EXPECT_FALSE(check_->measurement(0, 40 * kTenth));
  EXPECT_GT(deviation(70), 2);
}

TEST_F(NavigationCheckTest, WithoutSatellitesAPositionIsNoMeasurement) {
  accuracy_[10] = std::numeric_limits<double>::infinity();
  start();
  EXPECT_FALSE(check_->measurement(0, 10 * kTenth));
  EXPECT_TRUE(check_->measurement(0, 11 * kTenth));
}

TEST(NavigationCheckBefore, NavigationThatHasNotBegunMeasuresNothing) {
  const Trajectory navigation;
  const std::vector<double> none;
  NavigationCheck check(&navigation, none);
  EXPECT_EQ(check.observe(0, RigidMotion::Identity()), "");
  EXPECT_FALSE(check.has_fix());
  EXPECT_FALSE(check.stated_accuracy(0));
  EXPECT_FALSE(check.measurement(0, 0));
}

TEST(NavigationCheckWithout, HasNoFaults) {
  const std::vector<double> none;
  NavigationCheck check(nullptr, none);
  EXPECT_EQ(check.observe(0, RigidMotion::Identity()), "");
  EXPECT_FALSE(check.measurement(0, 0));
}

}  // namespace fovea::navigation_check_test
