// Where a vehicle's LiDAR, cameras and IMU sit.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "fovea/camera.h"
#include "fovea/geometry/lens.h"
#include "fovea/rigid_motion.h"
#include "fovea/simulation/simulation_options.h"

namespace fovea {

/// KITTI's arrangement with angles that are small and not zero, so that a forgotten rotation shows.
struct Rig {
  /// Vehicle: forward, left, up, on the road below the LiDAR. With the LiDAR's mount.
  RigidMotion T_vehicle_lidar = RigidMotion::Identity();
  std::vector<RigidMotion> T_lidar_further;           ///< of the further LiDARs
  RigidMotion T_imu_lidar = RigidMotion::Identity();  ///< of the GPS/INS
  /// Of the IMU of imu.csv; and as a calibration has it, without the planted error.
  RigidMotion T_lidar_imu = RigidMotion::Identity(), T_lidar_imu_calibrated = T_lidar_imu;
  /// Camera 0 before rectification (calib_velo_to_cam.txt).
  RigidMotion T_cam0_lidar = RigidMotion::Identity();
  Eigen::Matrix3d R_rect = Eigen::Matrix3d::Identity();  ///< of camera 0 (R_rect_00)
  /// Rectified, with T_cam_lidar, as a reader must find them, but for the rotation error that the
  /// options plant; in the options' order.
  std::vector<Camera> cameras;
  std::vector<LensCamera> optics;  ///< of the same cameras: what takes their images
  /// Of the same cameras as a calibration has it, without the planted error.
  std::vector<RigidMotion> T_cam_lidar_calibrated;
  /// P_rect's fourth column is K * t, of each camera: the origin of rectified camera 0 as the
  /// camera sees it (m).
  std::vector<Eigen::Vector3d> t;
};
/// What takes the images of a camera.
LensCamera lens_camera(const SimulatedCamera& camera, const CameraOptions& options);

/// ConfigError if a lens leaves nothing of its rectified image.
Rig make_rig(const SimulationOptions& options);

}  // namespace fovea
