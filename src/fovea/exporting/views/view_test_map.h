// A small map with posed images, for tests of what is exported of it.
#pragma once

#include <filesystem>
#include <vector>

#include "../../../../tests/sample_map.h"
#include "fovea/map/camera_models.h"
#include "fovea/map/meta_keys.h"

namespace fovea::view_test {

constexpr TimeNs kStamp = 1'600'000'000 * kNsPerSecond;
/// How long after its scan each image was taken.
constexpr double kDelay = 0.04;

/// Frame k, from 0, lies at (k, 2, 0.5), turned by 30 degrees about z, and drives ahead at 10 m/s.
inline RigidMotion T_local_lidar_of(int frame) {
  RigidMotion T(Eigen::Translation3d(frame, 2, 0.5));
  T.rotate(Eigen::AngleAxisd(0.5236, Eigen::Vector3d::UnitZ()));
  return T;
}

/// Looks ahead, a little to the left.
inline Camera camera_of(int index, double focal) {
  Camera camera;
  camera.index = index;
  camera.width = 640, camera.height = 200;
  camera.fx = focal, camera.fy = focal + 1;
  camera.cx = 310.25, camera.cy = 96;
  camera.T_cam_lidar.linear() << 0, -1, 0, 0, 0, -1, 1, 0, 0;
  camera.T_cam_lidar.rotate(Eigen::AngleAxisd(0.1, Eigen::Vector3d::UnitZ()));
  camera.T_cam_lidar.translation() = Eigen::Vector3d(0.06, -0.08, -0.27);
  return camera;
}

/// Frames 0 to 2, of which 1 is held out, and 3, which was skipped.
inline void write_map(const std::filesystem::path& path, const std::vector<Camera>& cameras,
                      bool states_cameras = true) {
  const auto writer = MapWriter::create(path, /*force=*/true);
  MapMeta meta{{meta_key::kTileSize, "4"}, {meta_key::kComplete, "1"}};
  if (states_cameras) store_camera_models(cameras, 0, meta);
  for (const auto& [key, value] : meta) writer->put_meta(key, value);
  DriveRecord drive;
  drive.name = "street";
  drive.kind = "generic";
  drive.end_frame = 4;
  writer->put_drive(0, drive);
  writer->put_submap(0, RigidMotion::Identity());
  for (int k = 0; k < 4; ++k) {
    FrameRecord frame;
    frame.index = k;
    frame.stamp = kStamp + k * (kNsPerSecond / 10);
    frame.status = k == 1   ? FrameStatus::kHeldOut
                   : k == 3 ? FrameStatus::kSkipped
                            : FrameStatus::kMapped;
    frame.T_local_lidar = T_local_lidar_of(k);
    frame.motion = SweepMotion{(Twist() << 0, 0, 0, 10, 0, 0).finished(), Twist::Zero()};
    frame.submap = k == 3 ? -1 : 0;
    for (const Camera& camera : cameras) {
      frame.views.push_back({camera.index, *frame.stamp + from_seconds(kDelay)});
    }
    writer->put_frame(frame);
  }
  PointCloud points = one_point_each({{1, 1, 1}, {1.01f, 1, 1}, {2, 1, 1}, {3, 3, 3}});
  writer->put_tile({0, {0, 0, 0}}, points);
  writer->finish();
}

/// Where a camera that drives ahead shows a point, by plain arithmetic: pixel centers at integers.
inline Eigen::Vector2d pixel_of(const Eigen::Vector3d& p_local, const Camera& camera, int frame) {
  const Eigen::Vector3d p_lidar = T_local_lidar_of(frame).inverse() * p_local;
  const Eigen::Vector3d p_later = p_lidar - Eigen::Vector3d(10 * kDelay, 0, 0);
  const Eigen::Vector3d p_cam = camera.T_cam_lidar * p_later;
  return {camera.fx * p_cam.x() / p_cam.z() + camera.cx,
          camera.fy * p_cam.y() / p_cam.z() + camera.cy};
}

/// In front of all cameras of the map.
inline const std::vector<Eigen::Vector3d> kPoints = {{14, 8, 1}, {20, 16, -1}, {30, 14, 4}};

}  // namespace fovea::view_test
