#include "fovea/pipeline/scan_edges.h"

#include "fovea/deskew.h"
#include "fovea/drive/scans/sensor_scans.h"
#include "fovea/geometry/transform_cloud.h"

namespace fovea {
namespace {

std::vector<LidarEdges> measured_edges(const PointCloud& scan_lidar, const Camera& camera,
                                       const DriveInfo& drive, double max_range) {
  if (drive.lidars.size() < 2) return {find_lidar_edges(scan_lidar, camera, max_range)};
  std::vector<LidarEdges> edges_lidar;
  const std::vector<PointCloud> scans = scans_by_sensor(scan_lidar, drive.lidars);
  for (std::size_t k = 0; k < scans.size(); ++k) {
    const RigidMotion& T_lidar_sensor = drive.lidars[k].T_lidar_sensor;
    Camera at_sensor = camera;
    at_sensor.T_cam_lidar = camera.T_cam_lidar * T_lidar_sensor;
    LidarEdges edges = find_lidar_edges(scans[k], at_sensor, max_range);
    edges.inside = transform_cloud(std::move(edges.inside), T_lidar_sensor);
    edges.outside = transform_cloud(std::move(edges.outside), T_lidar_sensor);
    edges_lidar.push_back(std::move(edges));
  }
  return edges_lidar;
}

}  // namespace

std::vector<LidarEdges> scan_edges(const PointCloud& scan_lidar, const Camera& camera,
                                   const DriveInfo& drive, const std::optional<SweepMotion>& motion,
                                   double max_range) {
  std::vector<LidarEdges> edges_lidar = measured_edges(scan_lidar, camera, drive, max_range);
  if (!motion) return edges_lidar;
  for (LidarEdges& edges : edges_lidar) {
    compensate_sweep(edges.inside, *motion, drive.sweep);
    compensate_sweep(edges.outside, *motion, drive.sweep);
  }
  return edges_lidar;
}

}  // namespace fovea
