#include "fovea/sensor/navigation.h"

#include <limits>
#include <stdexcept>

namespace fovea {
namespace {

Trajectory lidar_trajectory(const LocalTangentPlane& local, const std::vector<StampedOxts>& records,
                            const RigidMotion& T_imu_lidar) {
  std::vector<StampedPose> poses;
  poses.reserve(records.size());
  for (const StampedOxts& stamped : records) {
    RigidMotion T_enu_imu = RigidMotion::Identity();
    T_enu_imu.linear() = stamped.record.R_enu_imu();
    const RigidMotion T_local_imu = local.T_local_enu(stamped.record.position) * T_enu_imu;
    poses.push_back({stamped.time, T_local_imu * T_imu_lidar});
  }
  return Trajectory(std::move(poses));
}

std::vector<double> accuracies(const std::vector<StampedOxts>& records) {
  std::vector<double> result;
  for (const auto& [time, record] : records) {
    result.push_back(record.satellites == 0 ? std::numeric_limits<double>::infinity()
                                            : record.position_accuracy);
  }
  return result;
}

}  // namespace

Navigation make_navigation(const std::vector<StampedOxts>& records, const RigidMotion& T_imu_lidar,
                           TimeNs origin_time) {
  if (records.empty()) throw std::invalid_argument("navigation needs at least one record");
  // The origin is a pose of the very trajectory that is wanted: first in the frame of the first
  // record, then again in the origin's own.
  const LocalTangentPlane first(records.front().record.position);
  const Trajectory provisional = lidar_trajectory(first, records, T_imu_lidar);
  const RigidMotion T_first_lidar =
      provisional.at(origin_time).value_or(provisional.poses().front().T_local_body);
  const GeodeticPoint origin = first.to_geodetic(T_first_lidar.translation());
  return {lidar_trajectory(LocalTangentPlane(origin), records, T_imu_lidar), origin,
          accuracies(records)};
}

}  // namespace fovea
