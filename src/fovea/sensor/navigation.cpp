#include "fovea/sensor/navigation.h"

#include <limits>
#include <stdexcept>

namespace fovea {
namespace {

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
  if (poses.empty()) throw std::invalid_argument("navigation needs at least one pose");
  // The origin is a pose of the very trajectory that is wanted: first in the frame of the first
  // pose, then again in the origin's own.
  const LocalTangentPlane first(poses.front().position);
  const Trajectory provisional = lidar_trajectory(first, poses, T_body_lidar);
  const RigidMotion T_first_lidar =
      provisional.at(origin_time).value_or(provisional.poses().front().T_local_body);
  const GeodeticPoint origin = first.to_geodetic(T_first_lidar.translation());
  std::vector<double> accuracy;
  accuracy.reserve(poses.size());
  for (const GeodeticPose& pose : poses) accuracy.push_back(pose.accuracy);
  return {lidar_trajectory(LocalTangentPlane(origin), poses, T_body_lidar), origin,
          std::move(accuracy)};
}

Navigation make_navigation(const std::vector<StampedOxts>& records, const RigidMotion& T_imu_lidar,
                           TimeNs origin_time) {
  std::vector<GeodeticPose> poses;
  poses.reserve(records.size());
  for (const auto& [time, record] : records) {
    poses.push_back({time, record.position, record.R_enu_imu(),
                     record.satellites == 0 ? std::numeric_limits<double>::infinity()
                                            : record.position_accuracy,
                     record.velocity});
  }
  return navigation_of(poses, T_imu_lidar, origin_time);
}

}  // namespace fovea
