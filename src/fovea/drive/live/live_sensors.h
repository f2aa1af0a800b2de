// Numbers and names of the sensors of a live drive.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "fovea/drive/drive_description.h"

namespace fovea {

/// The first LiDAR is number 0. Places are those in drive.toml.
class LiveSensors {
 public:
  /// @param description  must outlive the sensors
  explicit LiveSensors(const DriveDescription& description) : description_(description) {}

  static constexpr std::size_t kLidar = 0;
  std::size_t further_lidar(std::size_t place) const { return 1 + place; }
  std::size_t camera(std::size_t place) const {
    return 1 + description_.further_lidars.size() + place;
  }
  std::size_t poses() const { return camera(description_.cameras.size()); }
  std::size_t positions() const { return poses() + 1; }
  std::size_t imu() const { return poses() + 2; }
  std::size_t wheels() const { return poses() + 3; }
  std::size_t size() const { return poses() + 4; }

  /// "camera front".
  std::string name(std::size_t sensor) const;
  std::vector<std::string> names() const;

  // By the names of drive.toml; std::invalid_argument for others.

  /// Place among the further LiDARs; absent: the first LiDAR.
  std::optional<std::size_t> find_further_lidar(const std::string& name) const;
  std::size_t find_camera(const std::string& name) const;

 private:
  const DriveDescription& description_;
};

}  // namespace fovea
