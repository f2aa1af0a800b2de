#include "fovea/drive/recordings/motion_messages.h"

#include <cmath>

namespace fovea {
namespace {

/// Of a coordinate on the ground (m).
double accuracy_of(const ros::NavSatFix& fix) {
  const double variance = (fix.covariance[0] + fix.covariance[4]) / 2;
  return fix.covariance_known && variance >= 0 ? std::sqrt(variance) : 0;
}

}  // namespace

std::optional<RecordedPosition> position_of(const ros::NavSatFix& fix) {
  const bool somewhere = std::isfinite(fix.latitude) && std::isfinite(fix.longitude) &&
                         std::isfinite(fix.altitude) && fix.fix;
  if (!somewhere) return std::nullopt;
  return RecordedPosition{fix.header.stamp,
                          {fix.latitude, fix.longitude, fix.altitude},
                          accuracy_of(fix),
                          std::nullopt};
}

std::optional<RecordedInertia> inertia_of(const ros::Imu& imu, const ImuUse& use) {
  if (use.orientations ? !imu.orientation : !use.rates) return std::nullopt;
  return RecordedInertia{imu.header.stamp, use.orientations ? imu.orientation : std::nullopt,
                         imu.angular_velocity, imu.acceleration};
}

RecordedPose pose_of(const ros::Odometry& odometry) {
  return {odometry.header.stamp, odometry.T_header_child};
}

}  // namespace fovea
