// KITTI's GPS/INS records (OXTS RT3003): oxts/data/NNNNNNNNNN.txt, one record of 30 numbers a file.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <variant>

#include "fovea/geometry/geodesy.h"
#include "fovea/rigid_motion.h"

namespace fovea {

/// What is used of a record.
struct OxtsRecord {
  GeodeticPoint position;
  /// rad. Roll: positive = left side up; pitch: positive = front down; yaw: 0 = east, positive =
  /// counter-clockwise seen from above.
  double roll = 0, pitch = 0, yaw = 0;
  double position_accuracy = 0;        ///< m, as the unit estimates it; 0: it does not state any
  std::optional<int> satellites = {};  ///< in use; absent: the record states no quality at all
  /// Of the imu in its own frame (forward, left, up), a second; see measured_velocity().
  std::optional<Twist> velocity = {};
  /// Of the imu as ImuSample has them.
  Eigen::Vector3d rate = Eigen::Vector3d::Zero(), force = Eigen::Vector3d::Zero();

  /// R = Rz(yaw) * Ry(pitch) * Rx(roll), from the imu (forward, left, up) to east-north-up there.
  Eigen::Matrix3d R_enu_imu() const;
};

/// The record of a text, or why it cannot be used ("has 29 numbers, not 30").
std::variant<OxtsRecord, std::string> parse_oxts(std::string_view text);

/// The same for a file; one that cannot be read gives a reason, too.
std::variant<OxtsRecord, std::string> read_oxts(const std::filesystem::path& file);

}  // namespace fovea
