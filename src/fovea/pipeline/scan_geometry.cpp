#include "fovea/pipeline/scan_geometry.h"

#include <algorithm>

#include "fovea/deskew.h"
#include "fovea/pipeline/drive_sensors.h"
#include "fovea/pipeline/lidar_views.h"

namespace fovea {

PointCloud deskewed(const PointCloud& scan, const std::optional<SweepMotion>& motion,
                    const DriveInfo& drive) {
  PointCloud scan_lidar = scan;
  if (motion && !drive.sweep_compensated) compensate_sweep(scan_lidar, *motion, drive.sweep);
  scan_lidar.time.clear();
  scan_lidar.ring.clear();
  return scan_lidar;
}

SweepSpan sweep_span(const PointCloud& scan, const DriveInfo& drive) {
  if (scan.time.empty()) return {drive.sweep.start_time(), drive.sweep.end_time()};
  const auto [first, last] = std::ranges::minmax(scan.time);
  return {double(first), double(last)};
}

std::vector<Camera> frame_cameras(const DriveInfo& drive, const Frame& frame,
                                  const std::optional<SweepMotion>& motion) {
  if (drive.calibration.cameras.empty()) {
    std::vector<Camera> views;
    for (const Eigen::Vector3d& origin : lidar_origins(drive)) {
      for (const Camera& view : lidar_views(origin)) views.push_back(view);
    }
    return views;
  }
  std::vector<Camera> cameras;
  cameras.reserve(drive.calibration.cameras.size());
  for (std::size_t slot = 0; slot < drive.calibration.cameras.size(); ++slot) {
    cameras.push_back(camera_of(drive, frame, slot).at_image(motion));
  }
  return cameras;
}

std::vector<Eigen::Vector3f> unmasked(const std::vector<Eigen::Vector3f>& points_cam,
                                      const Camera& camera, const ImageMask* mask) {
  if (mask == nullptr) return points_cam;
  std::vector<Eigen::Vector3f> seen;
  for (const Eigen::Vector3f& p : points_cam) {
    const Eigen::Vector2f pixel = camera.project(p.cast<double>()).value().cast<float>();
    if (!mask->covers(pixel.x(), pixel.y(), 1)) seen.push_back(p);
  }
  return seen;
}

}  // namespace fovea
