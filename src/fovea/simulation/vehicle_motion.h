// Where the vehicle, its LiDAR, cameras and IMU are at any time.
#pragma once

#include "fovea/geometry/camera.h"
#include "fovea/geometry/rigid_motion.h"
#include "fovea/simulation/path.h"
#include "fovea/simulation/simulation_options.h"

namespace fovea {

/// Motion of the vehicle along a path: speed that changes, weaving in the lane, roll, pitch and
/// heave; all smooth (sums of sines whose phases come from the seed). With speed_variation, weave,
/// sway and heave at 0 on a path of constant curvature its twist is constant.
class VehicleMotion {
 public:
  /// @param lane_offset  m to the left of the path (right-hand traffic: negative)
  VehicleMotion(const Path& path, double lane_offset, const VehicleOptions& options, int seed);

  /// World: x, y as the path's, z up, the road at 0. Vehicle: forward, left, up, on the road below
  /// the LiDAR. `time` in seconds from frame 0's stamp.
  RigidMotion T_world_vehicle(double time) const;
  /// Way along the path (m), 0 at time 0.
  double way(double time) const;

 private:
  const Path* path_;
  double lane_offset_;
  VehicleOptions options_;
  double phases_[8];
};

/// How far a path must reach before and beyond s = 0 for a drive of so many seconds.
double longest_way(const VehicleOptions& options, double seconds);

/// Where the sensors sit: KITTI's arrangement with angles that are small and not zero, so that a
/// forgotten rotation shows.
struct Rig {
  RigidMotion T_vehicle_lidar, T_imu_lidar;
  RigidMotion T_cam0_lidar;        ///< camera 0 before rectification (calib_velo_to_cam.txt)
  Eigen::Matrix3d R_rect;          ///< of camera 0 (R_rect_00)
  std::vector<Camera> cameras;     ///< rectified, with T_cam_lidar, as a reader must find them
  std::vector<Eigen::Vector3d> t;  ///< P_rect's fourth column is K * t, of each camera
};
Rig make_rig(const SimulationOptions& options);

}  // namespace fovea
