#include "fovea/drive/live/live_sensors.h"

namespace fovea {

std::string LiveSensors::name(std::size_t sensor) const {
  if (sensor == kLidar) return "the LiDAR";
  if (sensor < camera(0)) return "LiDAR " + description_.further_lidars[sensor - 1].name;
  if (sensor < poses()) return "camera " + description_.cameras[sensor - camera(0)].name;
  if (sensor == poses()) return "the source of poses";
  if (sensor == positions()) return "the source of positions";
  return sensor == imu() ? "the IMU" : "the source of wheel speeds";
}

}  // namespace fovea
