#include "fovea/drive/scans/sensor_scans.h"

#include <utility>

#include "fovea/geometry/transform_cloud.h"

namespace fovea {

void append_scan(PointCloud& scan_lidar, PointCloud scan_sensor, std::uint16_t number,
                 const RigidMotion& T_lidar_sensor, double delay) {
  for (float& time : scan_sensor.time) time += static_cast<float>(delay);
  PointCloud other = transform_cloud(std::move(scan_sensor), T_lidar_sensor);
  scan_lidar.sensor.resize(scan_lidar.size(), 0);
  other.sensor.assign(other.size(), number);
  // Keep rings only if all LiDARs have them.
  if (scan_lidar.ring.empty() || other.ring.empty()) {
    scan_lidar.ring.clear();
    other.ring.clear();
  }
  scan_lidar.append(other);
}

std::vector<PointCloud> scans_by_sensor(const PointCloud& scan_lidar,
                                        std::span<const MountedLidar> lidars) {
  if (lidars.size() < 2) return {scan_lidar};
  std::vector<std::vector<std::uint32_t>> indices(lidars.size());
  for (std::uint32_t i = 0; i < scan_lidar.size(); ++i) {
    indices.at(scan_lidar.sensor_at(i)).push_back(i);
  }
  std::vector<PointCloud> scans;
  for (std::size_t k = 0; k < lidars.size(); ++k) {
    PointCloud scan = scan_lidar.select(indices[k]);
    scan.sensor.clear();
    scans.push_back(transform_cloud(std::move(scan), lidars[k].T_lidar_sensor.inverse()));
  }
  return scans;
}

}  // namespace fovea
