#include "fovea/drive/navigation/navigation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "fovea/core/median.h"

namespace fovea {
namespace {

/// From the middle of a drive's positions a vehicle gets no further.
constexpr double kFastest = 100, kFarthest = 1000;  // m/s, and m whatever the time

bool has_fix(const GeodeticPose& pose) { return std::isfinite(pose.accuracy); }

/// The median of each earth-centered coordinate, of the positions with a fix if there are any.
Eigen::Vector3d middle_position(const std::vector<GeodeticPose>& poses) {
  const bool any_fix = std::any_of(poses.begin(), poses.end(), has_fix);
  std::array<std::vector<double>, 3> coordinates;
  for (const GeodeticPose& pose : poses) {
    if (any_fix && !has_fix(pose)) continue;
    const Eigen::Vector3d position = T_ecef_enu(pose.position).translation();
    for (int axis = 0; axis < 3; ++axis) {
      coordinates[static_cast<std::size_t>(axis)].push_back(position[axis]);
    }
  }
  Eigen::Vector3d middle;
  for (int axis = 0; axis < 3; ++axis) {
    middle[axis] = median_of(std::move(coordinates[static_cast<std::size_t>(axis)]));
  }
  return middle;
}

Trajectory lidar_trajectory(const LocalTangentPlane& local, const std::vector<GeodeticPose>& poses,
                            const RigidMotion& T_body_lidar) {
  std::vector<StampedPose> lidar;
  lidar.reserve(poses.size());
  for (const GeodeticPose& pose : poses) {
    RigidMotion T_enu_body = RigidMotion::Identity();
    T_enu_body.linear() = pose.R_enu_body;
    const RigidMotion T_local_body = local.T_local_enu(pose.position) * T_enu_body;
    lidar.push_back({pose.time, T_local_body * T_body_lidar, {}});
    if (pose.velocity) lidar.back().velocity = twist_of_part(*pose.velocity, T_body_lidar);
  }
  return Trajectory(std::move(lidar));
}

}  // namespace

Navigation navigation_of(const std::vector<GeodeticPose>& poses, const RigidMotion& T_body_lidar,
                         TimeNs origin_time) {
  return navigation_around(lidar_position(poses, T_body_lidar, origin_time), poses, T_body_lidar);
}

GeodeticPoint lidar_position(const std::vector<GeodeticPose>& poses,
                             const RigidMotion& T_body_lidar, TimeNs time) {
  if (poses.empty()) throw std::invalid_argument("navigation needs at least one pose");
  // A pose of the very trajectory that is wanted, here in the frame of the first pose.
  const LocalTangentPlane first(poses.front().position);
  const Trajectory trajectory = lidar_trajectory(first, poses, T_body_lidar);
  const RigidMotion T_first_lidar =
      trajectory.at(time).value_or(trajectory.poses().front().T_local_body);
  return first.to_geodetic(T_first_lidar.translation());
}

Navigation navigation_around(const GeodeticPoint& origin, const std::vector<GeodeticPose>& poses,
                             const RigidMotion& T_body_lidar) {
  const bool any_fix = std::any_of(poses.begin(), poses.end(), has_fix);
  std::vector<double> accuracy;
  accuracy.reserve(poses.size());
  for (const GeodeticPose& pose : poses) accuracy.push_back(pose.accuracy);
  return {lidar_trajectory(LocalTangentPlane(origin), poses, T_body_lidar),
          any_fix ? std::optional(origin) : std::nullopt, std::move(accuracy)};
}

std::vector<bool> far_positions(const std::vector<GeodeticPose>& poses) {
  std::vector<bool> far(poses.size());
  if (poses.empty()) return far;
  const Eigen::Vector3d middle = middle_position(poses);
  const double reach = kFarthest + kFastest * seconds(poses.back().time - poses.front().time);
  for (std::size_t i = 0; i < poses.size(); ++i) {
    far[i] = !((T_ecef_enu(poses[i].position).translation() - middle).norm() <= reach);
  }
  return far;
}

std::string no_fix_note(const std::filesystem::path& positions) {
  return positions.string() + " has no position with a fix: the map will not be georeferenced";
}

std::vector<GeodeticPose> geodetic_poses(const std::vector<StampedOxts>& records) {
  std::vector<GeodeticPose> poses;
  poses.reserve(records.size());
  for (const auto& [time, record] : records) {
    poses.push_back({time, record.position, record.R_enu_imu(),
                     record.satellites == 0 ? std::numeric_limits<double>::infinity()
                                            : record.position_accuracy,
                     record.velocity});
  }
  return poses;
}

Navigation make_navigation(const std::vector<StampedOxts>& records, const RigidMotion& T_imu_lidar,
                           TimeNs origin_time) {
  return navigation_of(geodetic_poses(records), T_imu_lidar, origin_time);
}

}  // namespace fovea
