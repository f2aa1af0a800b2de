// A pose that Fovea reports while it maps or localizes.
#pragma once

#include <optional>
#include <string>

#include "fovea/rigid_motion.h"
#include "fovea/time.h"

namespace fovea::bridge {

/// Frames of published poses. The LiDAR has a frame of its own, so that the robot's tree of
/// transforms stays a tree: a frame in it has only one parent.
inline constexpr const char* kWorldFrame = "fovea_local";
inline constexpr const char* kLidarFrame = "fovea_lidar";

using PoseCovariance = Eigen::Matrix<double, 6, 6>;

struct PublishedPose {
  int frame = 0;
  TimeNs stamp = 0;
  RigidMotion T_world_lidar = RigidMotion::Identity();
  /// Of a twist of the LiDAR in its own frame: rotation first (rad^2, m^2). Empty if unknown.
  std::optional<PoseCovariance> covariance;
  std::string state;  ///< one word: "tracked", "lost", "restarted", "localized"
};

/// The covariance in the order and frame of geometry_msgs/PoseWithCovariance: x, y, z, then
/// rotations about the fixed axes x, y, z of the world. Empty if it is unknown.
inline std::optional<PoseCovariance> covariance_in_world(const PublishedPose& pose) {
  if (!pose.covariance || !pose.covariance->allFinite()) return std::nullopt;
  PoseCovariance to_world = PoseCovariance::Zero();
  to_world.topRightCorner<3, 3>() = pose.T_world_lidar.linear();
  to_world.bottomLeftCorner<3, 3>() = pose.T_world_lidar.linear();
  return to_world * *pose.covariance * to_world.transpose();
}

}  // namespace fovea::bridge
