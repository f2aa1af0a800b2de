// What messages of navigation become in a drive.
#pragma once

#include <optional>

#include "fovea/drive/recordings/ros_messages.h"
#include "fovea/drive/writers/generic_drive_writer.h"

namespace fovea {

/// Absent for a message without a fix.
std::optional<RecordedPosition> position_of(const ros::NavSatFix& fix);

/// What of an IMU is used.
struct ImuUse {
  bool orientations = false;
  bool rates = false;  ///< and accelerations
};

/// Absent for a message without what is used.
std::optional<RecordedInertia> inertia_of(const ros::Imu& imu, const ImuUse& use);

RecordedPose pose_of(const ros::Odometry& odometry);

}  // namespace fovea
