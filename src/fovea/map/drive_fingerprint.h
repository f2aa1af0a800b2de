// Hashes that identify a drive by its calibration and its stamps, not by its name
// (docs/map-format.md).
#pragma once

#include <map>
#include <optional>
#include <span>
#include <string>

#include "fovea/camera.h"
#include "fovea/geometry/sensor_profile.h"
#include "fovea/time.h"

namespace fovea {

/// "imu:HASH lidar_1:HASH 2:HASH 3:HASH": one hash of 16 hexadecimal digits for the place of the
/// IMU, where it is known, for the pose of each further LiDAR, and for each camera, so that drives
/// with other cameras in use can be compared. Numbers count in whole 1e-9, so that the rounding of
/// another computer changes nothing.
/// @param lidars  of the drive; empty: one
std::string calibration_fingerprint(const Calibration& calibration,
                                    std::span<const MountedLidar> lidars);

/// The parts of a calibration's fingerprint: hash by "imu", "lidar_1" or the number of a camera.
std::map<std::string, std::string> fingerprint_parts(const std::string& fingerprint);

/// A calibration's fingerprint without the place of the IMU, which is that of navigation.
std::string without_imu(const std::string& fingerprint);

/// What differs between two calibrations, as in "camera 2, the place of the IMU"; nothing if
/// they are equal.
std::optional<std::string> calibration_difference(const std::string& a, const std::string& b);

/// Of the stamps of consecutive frames: 32 hexadecimal digits.
/// @param first_frame  the number of the first one
std::string stamps_fingerprint(int first_frame, std::span<const std::optional<TimeNs>> stamps);

}  // namespace fovea
