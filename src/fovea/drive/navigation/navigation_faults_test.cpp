#include "fovea/drive/navigation/navigation_faults.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <numbers>

#include "fovea/core/angle.h"
#include "fovea/core/random.h"
#include "fovea/drive/navigation/navigation.h"

namespace fovea::navigation_faults_test {

using testing::HasSubstr;
using testing::StartsWith;

constexpr int kFrames = 60;

RigidMotion turned(double yaw, const Eigen::Vector3d& position) {
  RigidMotion T(Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()));
  T.pretranslate(position);
  return T;
}

/// A vehicle that drives a meter a frame. Registration of its scans is right.
class NavigationFaultsTest : public testing::Test {
 protected:
  /// T_world_body at a distance; world: east, north, up.
  RigidMotion T_world_body(double way) const {
    const double radius = 1 / bend_;
    return turned(0.4 + bend_ * way, {radius * (std::sin(0.4 + bend_ * way) - std::sin(0.4)),
                                      radius * (std::cos(0.4) - std::cos(0.4 + bend_ * way)), 0});
  }
  double way(int frame) const { return speed_ * frame; }

  /// The likely cause for a drive with an error in its positions on earth.
  std::string cause_of_positions(const std::function<void(GeodeticPose&)>& error) {
    const LocalTangentPlane local({49, 8.4, 100});
    std::vector<GeodeticPose> poses;
    for (int i = 0; i < kFrames; ++i) {
      GeodeticPose pose;
      pose.time = i * kNsPerSecond / 10;
      pose.position = local.to_geodetic(T_world_body(way(i)).translation());
      pose.R_enu_body = T_world_body(way(i)).linear();
      error(pose);
      poses.push_back(pose);
    }
    const Navigation navigation = navigation_of(poses, T_body_lidar_given_, 0);
    drive_.origin = navigation.origin;
    std::vector<RigidMotion> T_local_lidar;
    for (const StampedPose& pose : navigation.trajectory.poses()) {
      T_local_lidar.push_back(pose.T_local_body);
    }
    return cause(T_local_lidar);
  }

  /// The likely cause for a drive with an error in its poses.
  std::string cause_of_poses(const std::function<RigidMotion(const RigidMotion&)>& error) {
    drive_.origin.reset();
    std::vector<RigidMotion> T_local_lidar;
    for (int i = 0; i < kFrames; ++i) {
      T_local_lidar.push_back(error(T_world_body(way(i))) * T_body_lidar_given_);
    }
    const Eigen::Vector3d origin = T_local_lidar.front().translation();
    for (RigidMotion& pose : T_local_lidar) pose.pretranslate(-origin);
    return cause(T_local_lidar);
  }

  /// "" if none is likely.
  std::string cause(const std::vector<RigidMotion>& T_local_lidar) {
    drive_.calibration.T_imu_lidar = T_body_lidar_given_;
    NavigationFaults faults(drive_);
    const RigidMotion T_lidar_first = (T_world_body(0) * T_body_lidar_).inverse();
    for (int i = 0; i < kFrames; ++i) {
      faults.add(T_local_lidar[std::size_t(i)],
                 T_lidar_first * T_world_body(way(i)) * T_body_lidar_);
    }
    return faults.likely_cause().value_or("");
  }

  static GeodeticPose with_yaw(GeodeticPose pose, double yaw) {
    pose.R_enu_body = turned(yaw, Eigen::Vector3d::Zero()).linear();
    return pose;
  }
  static double yaw_of(const GeodeticPose& pose) {
    return std::atan2(pose.R_enu_body(1, 0), pose.R_enu_body(0, 0));
  }

  double bend_ = 0.02, speed_ = 1;  // 1/m, m a frame
  RigidMotion T_body_lidar_ = turned(0.01, {0.8, -0.3, 0.9}), T_body_lidar_given_ = T_body_lidar_;
  DriveInfo drive_;
};

const auto kNoError = [](GeodeticPose&) {};
const auto kAsItIs = [](const RigidMotion& T) { return T; };

TEST_F(NavigationFaultsTest, RightNavigationHasNone) {
  for (const double bend : {1e-6, 0.02, -0.05}) {
    bend_ = bend;
    for (const double speed : {1.0, -0.5, 2.5}) {  // backward, too
      speed_ = speed;
      EXPECT_EQ(cause_of_positions(kNoError), "") << bend << " " << speed;
      EXPECT_EQ(cause_of_poses(kAsItIs), "") << bend << " " << speed;
    }
  }
}

TEST_F(NavigationFaultsTest, NoiseAndStandingAreNoFault) {
  Random random(3);
  const auto jitter = [&](double sigma) {
    return [&random, sigma](RigidMotion T) {
      for (int axis = 0; axis < 3; ++axis) T.translation()[axis] += sigma * random.normal();
      return T;
    };
  };
  EXPECT_EQ(cause_of_poses(jitter(0.03)), "");
  EXPECT_EQ(cause_of_poses(jitter(1)), "");  // wrong, but by no known error
  speed_ = 0;
  EXPECT_EQ(cause_of_poses(jitter(1)), "");
  double drift = 0;
  EXPECT_EQ(cause_of_poses([&](RigidMotion T) {
              T.translation().x() += 0.5 * ++drift;
              return T;
            }),
            "");
}

TEST_F(NavigationFaultsTest, LatitudeAndLongitudeInRadians) {
  for (const double bend : {1e-6, 0.02}) {
    bend_ = bend;
    EXPECT_EQ(cause_of_positions([](GeodeticPose& pose) {
                pose.position.latitude *= kDegree;
                pose.position.longitude *= kDegree;
              }),
              "navigation does not fit the scans; likely cause: latitude and longitude are in "
              "radians, not in degrees");
  }
}

TEST_F(NavigationFaultsTest, LatitudeAndLongitudeSwapped) {
  const auto swap = [](GeodeticPose& pose) {
    std::swap(pose.position.latitude, pose.position.longitude);
  };
  EXPECT_THAT(cause_of_positions(swap), HasSubstr("cause: latitude and longitude are swapped"));
  // Headings computed from the swapped positions.
  bend_ = 1e-6;
  EXPECT_THAT(cause_of_positions([&](GeodeticPose& pose) {
                const double yaw = yaw_of(pose);
                pose = with_yaw(pose, std::atan2(std::cos(yaw) / std::cos(49 * kDegree),
                                                 std::sin(yaw) * std::cos(8.4 * kDegree)));
                swap(pose);
              }),
              HasSubstr("cause: latitude and longitude are swapped"));
}

TEST_F(NavigationFaultsTest, ConventionsOfYaw) {
  EXPECT_THAT(cause_of_positions([](GeodeticPose& pose) {
                pose = with_yaw(pose, std::numbers::pi / 2 - yaw_of(pose));
              }),
              HasSubstr("cause: yaw grows clockwise from north"));
  EXPECT_THAT(cause_of_positions([](GeodeticPose& pose) {
                pose = with_yaw(pose, yaw_of(pose) - std::numbers::pi / 2);
              }),
              HasSubstr("cause: yaw counts from north, not from east"));
}

TEST_F(NavigationFaultsTest, AnglesInDegrees) {
  bend_ = 0.001;  // from 0 to 3.4 degrees: angles that radians may have
  const auto T_world_body = [&](double at) { return bend_ * at; };
  int frame = 0;
  EXPECT_THAT(cause_of_positions([&](GeodeticPose& pose) {
                const double yaw = T_world_body(way(frame++));
                const Eigen::Matrix3d to_east = turned(-0.4, {0, 0, 0}).linear();
                const LocalTangentPlane local({49, 8.4, 100});
                pose.position =
                    local.to_geodetic(to_east * local.T_local_enu(pose.position).translation());
                pose = with_yaw(pose, yaw / kDegree);
              }),
              HasSubstr("roll, pitch and yaw are in degrees"));
}

TEST_F(NavigationFaultsTest, InvertedPoses) {
  const auto inverted = [](const RigidMotion& T) { return T.inverse(); };
  EXPECT_THAT(cause_of_poses(inverted), HasSubstr("cause: poses are T_body_world"));
  EXPECT_THAT(
      cause_of_poses([&](const RigidMotion& T) { return (turned(1, {40, -70, 3}) * T).inverse(); }),
      HasSubstr("cause: poses are T_body_world"));
  bend_ = 1e-6;
  EXPECT_THAT(cause_of_poses([](const RigidMotion& T) { return T.inverse(); }),
              HasSubstr("poses are T_body_world"));
  EXPECT_THAT(cause_of_positions(
                  [](GeodeticPose& pose) { pose.R_enu_body = pose.R_enu_body.transpose().eval(); }),
              HasSubstr("attitudes are of east-north-up in the body"));
}

TEST_F(NavigationFaultsTest, InvertedPositionOfTheLidar) {
  T_body_lidar_ = turned(0.5 * std::numbers::pi, {0.8, -0.3, 0.9});
  T_body_lidar_given_ = T_body_lidar_.inverse();
  EXPECT_THAT(cause_of_poses(kAsItIs), HasSubstr("cause: T_body_lidar is inverted"));
  EXPECT_THAT(cause_of_positions(kNoError), HasSubstr("cause: T_body_lidar is inverted"));
  // Small rotation: only turns show the lever arm.
  T_body_lidar_ = turned(0.01, {0.8, -0.3, 0.9});
  T_body_lidar_given_ = T_body_lidar_.inverse();
  EXPECT_THAT(cause_of_poses(kAsItIs), HasSubstr("cause: T_body_lidar is inverted"));
  bend_ = 1e-6;
  EXPECT_EQ(cause_of_poses(kAsItIs), "");
}

TEST_F(NavigationFaultsTest, OtherUnitsAndTurns) {
  EXPECT_THAT(cause_of_poses([](RigidMotion T) {
                T.translation() /= 0.3048;
                return T;
              }),
              HasSubstr("lengths are 3.2"));
  T_body_lidar_given_ = turned(70 * kDegree, {0, 0, 0}) * T_body_lidar_;
  EXPECT_THAT(cause_of_poses(kAsItIs), HasSubstr("turned by 70 degrees"));
}

TEST_F(NavigationFaultsTest, InterruptedFramesFormNoStep) {
  NavigationFaults faults(drive_);
  for (int i = 0; i < kFrames; ++i) {
    faults.add(turned(1.5, {3.0 * i, 0, 0}) * T_world_body(way(i)), T_world_body(way(i)));
    faults.interrupt();
  }
  EXPECT_FALSE(faults.likely_cause());
}

}  // namespace fovea::navigation_faults_test
