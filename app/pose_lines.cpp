#include "app/pose_lines.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "fovea/geometry/quaternion_motion.h"

namespace fovea::app {

std::string pose_line(const bridge::PublishedPose& pose) {
  const QuaternionMotion T(pose.T_world_lidar);
  const Eigen::Vector3d& t = T.translation;
  const Eigen::Quaterniond q = T.rotation.normalized();
  std::string line =
      fmt::format("{} {} {} {:.6f} {:.6f} {:.6f} {:.9f} {:.9f} {:.9f} {:.9f}", pose.frame,
                  pose.stamp, pose.state, t.x(), t.y(), t.z(), q.x(), q.y(), q.z(), q.w());
  if (const auto covariance = bridge::covariance_in_world(pose)) {
    for (const double variance : covariance->diagonal()) {
      line +=
          fmt::format(" {:.4g}", std::sqrt(std::max(variance, 0.0)));  // rounding may be below 0
    }
  }
  return line;
}

}  // namespace fovea::app
