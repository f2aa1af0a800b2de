// KITTI's calibration files.
#pragma once

#include <filesystem>
#include <map>
#include <optional>

#include "fovea/camera.h"

namespace fovea {

/// What the calibration files of a drive say, of all its cameras.
struct KittiCalibration {
  /// By camera number. Size 0 x 0 where the files do not give it (odometry).
  std::map<int, Camera> cameras;
  RigidMotion T_cam0_lidar = RigidMotion::Identity();  ///< rectified camera 0
  std::optional<RigidMotion> T_imu_lidar;
};

/// Reads calib_cam_to_cam.txt, calib_velo_to_cam.txt and, where it is, calib_imu_to_velo.txt of a
/// raw drive's date folder. p = P_rect_k * R_rect_00 * T_cam0_lidar * X; the fourth column of
/// P_rect_k is K * t with t the way from camera 0 to camera k, and goes into T_cam_lidar
/// (docs/method.md 1). InputError with file and line for what is missing, has the wrong count of
/// numbers, or is not a rotation or projection.
KittiCalibration read_kitti_raw_calibration(const std::filesystem::path& date_folder);

/// Reads calib.txt of an odometry sequence: P0..P3 as P_rect above, Tr as R_rect_00 * T_cam0_lidar.
KittiCalibration read_kitti_odometry_calibration(const std::filesystem::path& file);

}  // namespace fovea
