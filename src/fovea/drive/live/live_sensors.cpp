#include "fovea/drive/live/live_sensors.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

namespace fovea {

std::string LiveSensors::name(std::size_t sensor) const {
  if (sensor == kLidar) return "the LiDAR";
  if (sensor < camera(0)) return "LiDAR " + description_.further_lidars[sensor - 1].name;
  if (sensor < poses()) return "camera " + description_.cameras[sensor - camera(0)].name;
  if (sensor == poses()) return "the source of poses";
  if (sensor == positions()) return "the source of positions";
  return sensor == imu() ? "the IMU" : "the source of wheel speeds";
}

std::vector<std::string> LiveSensors::names() const {
  std::vector<std::string> names;
  names.reserve(size());
  for (std::size_t i = 0; i < size(); ++i) names.push_back(name(i));
  return names;
}

std::optional<std::size_t> LiveSensors::find_further_lidar(const std::string& name) const {
  if (name.empty() || name == description_.lidar.name) return std::nullopt;
  const auto& further = description_.further_lidars;
  const auto found = std::find_if(further.begin(), further.end(),
                                  [&](const LidarDescription& l) { return l.name == name; });
  if (found != further.end()) return std::size_t(found - further.begin());
  throw std::invalid_argument(fmt::format("the drive has no LiDAR '{}'", name));
}

std::size_t LiveSensors::find_camera(const std::string& name) const {
  const auto& cameras = description_.cameras;
  const auto found = std::find_if(cameras.begin(), cameras.end(),
                                  [&](const CameraDescription& c) { return c.name == name; });
  if (found != cameras.end()) return std::size_t(found - cameras.begin());
  throw std::invalid_argument(fmt::format("the drive has no camera '{}'", name));
}

}  // namespace fovea
