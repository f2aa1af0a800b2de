#include "fovea/pipeline/fusion.h"

#include <gtest/gtest.h>

#include <limits>
#include <numbers>

#include "fovea/core/random.h"

namespace fovea::fusion_test {

constexpr TimeNs kTenth = kNsPerSecond / 10;
constexpr int kLap = 300;       // frames
constexpr double kRadius = 45;  // m: 0.94 m a frame

RigidMotion true_pose(int frame) {
  const double angle = 2 * std::numbers::pi * frame / kLap;
  RigidMotion T(
      Eigen::Translation3d(kRadius * std::sin(angle), kRadius * (1 - std::cos(angle)), 0));
  T.rotate(Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()));
  return T;
}

/// A scan of irregular pillars along the circle, and of the ground.
std::vector<Eigen::Vector3f> scan_at(const RigidMotion& T_local_lidar) {
  std::vector<Eigen::Vector3f> points;
  const RigidMotion T = T_local_lidar.inverse();
  const auto add = [&](const Eigen::Vector3d& p_local) {
    const Eigen::Vector3d p = T * p_local;
    if (p.norm() < 40) points.push_back(p.cast<float>());
  };
  for (int pillar = 0; pillar < 80; ++pillar) {
    Random random = Random::of_item(1, 2, std::uint64_t(pillar));
    const double angle = 2 * std::numbers::pi * (pillar + 0.7 * random.uniform()) / 80;
    const double radius = kRadius + (pillar % 2 == 0 ? 8 : -8) * (1 + random.uniform());
    const Eigen::Vector2d center(radius * std::sin(angle), kRadius - radius * std::cos(angle));
    const double size = 0.5 + random.uniform();
    for (double s = -size; s <= size; s += 0.25) {
      for (double z = -1.5; z < 3; z += 0.25) {
        for (const double side : {-size, size}) {
          add({center.x() + s, center.y() + side, z});
          add({center.x() + side, center.y() + s, z});
        }
      }
    }
  }
  for (double x = -40; x <= 40; x += 1) {
    for (double y = -40; y <= 40; y += 1) {
      const Eigen::Vector3d near = T_local_lidar * Eigen::Vector3d(x, y, 0);
      add({std::round(near.x()), std::round(near.y()), -1.7});
    }
  }
  return points;
}

/// Odometry that rotates slightly too far every frame.
struct Odometry {
  double turn;  // rad a frame too much
  RigidMotion T_odom_lidar = RigidMotion::Identity();
  void step(int frame) {
    if (frame == 0) return;
    T_odom_lidar = T_odom_lidar * (true_pose(frame - 1).inverse() * true_pose(frame)) *
                   Eigen::AngleAxisd(turn, Eigen::Vector3d::UnitZ());
  }
};

std::vector<FrameResult> drive(Fusion& fusion, double turn, int frames, bool with_scans) {
  Odometry odometry{turn};
  std::vector<FrameResult> results;
  for (int i = 0; i < frames; ++i) {
    odometry.step(i);
    FrameResult result;
    result.index = i;
    result.stamp = i * kTenth;
    result.poses.T_odom_lidar = odometry.T_odom_lidar;
    fusion.track(result);
    if (with_scans && fusion.is_scan_requested())
      fusion.add_scan_and_close_loops(result, scan_at(true_pose(i)));
    results.push_back(result);
  }
  return results;
}

double error_of(const RigidMotion& T_local_lidar, int frame) {
  return (T_local_lidar.translation() - true_pose(frame).translation()).norm();
}

TEST(Fusion, WithoutNavigationAndLoopsLocalIsOdom) {
  DriveInfo info;
  const MotionHistory history(info);
  Fusion fusion({}, {}, history);
  const auto results = drive(fusion, 1e-4, 100, /*with_scans=*/false);
  for (const FrameResult& result : results) {
    EXPECT_TRUE(result.poses.T_local_lidar.isApprox(result.poses.T_odom_lidar, 1e-9))
        << result.index;
  }
  // 9.9 s: a submap every 2 s.
  EXPECT_EQ(fusion.submaps().size(), 5u);
  EXPECT_EQ(results.back().poses.submap, 4);
}

TEST(Fusion, AStandingVehicleStaysInItsSubmap) {
  DriveInfo info;
  const MotionHistory history(info);
  Fusion fusion({}, {}, history);
  for (int i = 0; i < 200; ++i) {
    FrameResult result;
    result.stamp = i * kTenth;
    fusion.track(result);
  }
  EXPECT_EQ(fusion.submaps().size(), 1u);
}

TEST(Fusion, ARevisitedPlaceClosesTheLoop) {
  constexpr double kTurn = 1e-4;  // 1.7 degrees a lap
  DriveInfo info;
  const MotionHistory history(info);
  Fusion open({.loop_closure = false}, {}, history), closed({}, {}, history);
  const int frames = kLap + 40;
  const auto drifted = drive(open, kTurn, frames, true);
  auto results = drive(closed, kTurn, frames, true);
  EXPECT_GT(error_of(drifted[kLap].poses.T_local_lidar, kLap), 1.0);
  int revisits = 0;
  for (const FrameResult& result : results) revisits += result.poses.revisit.has_value();
  EXPECT_GE(revisits, 1);
  EXPECT_LT(error_of(results.back().poses.T_local_lidar, frames - 1), 0.1);
  for (int i = 0; i < frames; ++i) {
    EXPECT_LT(error_of(closed.T_local_lidar(results[std::size_t(i)]), i), 0.4) << i;
  }
}

TEST(Fusion, OtherPlacesCloseNoLoop) {
  DriveInfo info;
  const MotionHistory history(info);
  Fusion fusion({}, {}, history);
  for (const FrameResult& result : drive(fusion, 0, kLap * 3 / 4, true)) {
    EXPECT_FALSE(result.poses.revisit) << result.index;
  }
}

TEST(Fusion, NavigationHoldsALongDriveInPlace) {
  DriveInfo info;
  std::vector<StampedPose> poses;
  for (int i = 0; i < 3 * kLap; ++i) {
    Random random = Random::of_item(5, 6, std::uint64_t(i));
    RigidMotion T = true_pose(i);
    for (int axis = 0; axis < 3; ++axis) T.translation()[axis] += 0.03 * random.normal();
    poses.push_back({i * kTenth, T});
  }
  info.navigation = Trajectory(poses);
  info.navigation_accuracy.assign(poses.size(), 0.1);
  const MotionHistory history(info);
  Fusion fusion({.loop_closure = false}, {}, history);
  auto results = drive(fusion, 6e-5, 3 * kLap, false);
  const double without = error_of(results.back().poses.T_odom_lidar, 3 * kLap - 1);
  EXPECT_GT(without, 2);
  double worst = 0;
  for (int i = 0; i < 3 * kLap; ++i) {
    worst = std::max(worst, error_of(fusion.T_local_lidar(results[std::size_t(i)]), i));
  }
  EXPECT_LT(worst, without / 3);
}

// The first frames have no position, or none with a fix; odometry begins elsewhere.
TEST(Fusion, NavigationThatBeginsLaterMovesTheSubmapsBeforeIt) {
  for (const bool without_fix : {false, true}) {
    DriveInfo info;
    const RigidMotion T_local_true = RigidMotion(Eigen::Translation3d(300, -200, 5)) *
                                     RigidMotion(Eigen::AngleAxisd(1.5, Eigen::Vector3d::UnitZ()));
    std::vector<StampedPose> poses;
    for (int i = without_fix ? 0 : 70; i < 200; ++i) {
      const bool has_fix = i >= 70;
      poses.push_back({i * kTenth, has_fix ? T_local_true * true_pose(i) : true_pose(0)});
      info.navigation_accuracy.push_back(has_fix ? 0.1 : std::numeric_limits<double>::infinity());
    }
    info.navigation = Trajectory(poses);
    const MotionHistory history(info);
    Fusion fusion({.loop_closure = false}, {}, history);
    const auto results = drive(fusion, 0, 200, false);
    for (int i = 0; i < 200; ++i) {
      const RigidMotion T = fusion.T_local_lidar(results[std::size_t(i)]);
      EXPECT_LT((T.translation() - (T_local_true * true_pose(i)).translation()).norm(), 0.05)
          << without_fix << " " << i;
    }
  }
}

// Of a live drive, nothing shows before that navigation begins.
TEST(Fusion, NavigationThatBeginsUnexpectedlyMovesTheSubmapsBeforeIt) {
  constexpr int kBegin = 70, kFrames = 200;
  DriveInfo info;
  info.kind = kLiveDrive;
  MotionHistory history(info);
  Fusion fusion({.loop_closure = false}, {}, history);
  const RigidMotion T_local_true = RigidMotion(Eigen::Translation3d(300, -200, 5)) *
                                   RigidMotion(Eigen::AngleAxisd(1.5, Eigen::Vector3d::UnitZ()));
  Odometry odometry{0};
  std::vector<FrameResult> results;
  for (int i = 0; i < kFrames; ++i) {
    // The first heading is wrong: later ones correct it.
    const RigidMotion turned(Eigen::AngleAxisd(i == kBegin ? 0.05 : 0, Eigen::Vector3d::UnitZ()));
    MotionData data;
    data.poses = {{i * kTenth, T_local_true * true_pose(i) * turned}};
    data.accuracy = {0.1};
    if (i >= kBegin) history.add(data);
    odometry.step(i);
    FrameResult& result = results.emplace_back();
    result.stamp = i * kTenth;
    result.poses.T_odom_lidar = odometry.T_odom_lidar;
    fusion.track(result);
    EXPECT_EQ(result.tracking.has_navigation_begun, i == kBegin) << i;
  }
  for (int i = 0; i < kFrames; ++i) {
    const RigidMotion T = fusion.T_local_lidar(results[std::size_t(i)]);
    EXPECT_LT((T.translation() - (T_local_true * true_pose(i)).translation()).norm(), 0.5) << i;
  }
}

TEST(Fusion, SwitchedOffItChangesNoPose) {
  DriveInfo info;
  std::vector<StampedPose> poses;
  for (int i = 0; i < 100; ++i) {
    poses.push_back({i * kTenth, RigidMotion(Eigen::Translation3d(1, 2, 3)) * true_pose(i)});
  }
  info.navigation = Trajectory(poses);
  const MotionHistory history(info);
  Fusion fusion({.enabled = false}, {}, history);
  for (const FrameResult& result : drive(fusion, 1e-3, 100, false)) {
    EXPECT_EQ(result.poses.T_local_lidar.matrix(), result.poses.T_odom_lidar.matrix());
  }
}

TEST(Fusion, ReplayedFramesGiveTheSameResult) {
  DriveInfo info;
  const MotionHistory history(info);
  Fusion first({}, {}, history), again({}, {}, history);
  const auto results = drive(first, 1e-4, kLap + 30, true);
  for (const FrameResult& result : results) {
    FrameResult tracked = result;
    again.track(tracked);
    if (again.is_scan_requested()) again.replay(result, scan_at(true_pose(result.index)));
  }
  ASSERT_EQ(first.submaps().size(), again.submaps().size());
  for (std::size_t i = 0; i < first.submaps().size(); ++i) {
    EXPECT_EQ(first.submaps()[i].matrix(), again.submaps()[i].matrix()) << i;
  }
}

}  // namespace fovea::fusion_test
