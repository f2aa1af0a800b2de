#include "fovea/simulation/rig.h"

#include "fovea/base/angle.h"
#include "fovea/geometry/rigid_motion.h"

namespace fovea {
namespace {

/// Rz(z) * Ry(y) * Rx(x), degrees.
Eigen::Matrix3d rotation(double x, double y, double z) {
  return (Eigen::AngleAxisd(z * kDegree, Eigen::Vector3d::UnitZ()) *
          Eigen::AngleAxisd(y * kDegree, Eigen::Vector3d::UnitY()) *
          Eigen::AngleAxisd(x * kDegree, Eigen::Vector3d::UnitX()))
      .toRotationMatrix();
}

RigidMotion motion(const Eigen::Matrix3d& R, const Eigen::Vector3d& t) {
  RigidMotion T = RigidMotion::Identity();
  T.linear() = R;
  T.translation() = t;
  return T;
}

/// Rectified cameras look the same way from places that differ mostly sideways.
Eigen::Vector3d camera_translation(const SimulatedCamera& camera) {
  if (camera.number == 0) return {-camera.right, 0, 0};
  return {-camera.right, 0.001 * (camera.number - 2.5), 0.003};
}

}  // namespace

Rig make_rig(const SimulationOptions& options) {
  Rig rig;
  rig.T_vehicle_lidar = motion(rotation(0.15, 0.25, -0.2), {0, 0, options.lidar.height});
  // The IMU sits behind, to the left of and below the LiDAR.
  const RigidMotion T_lidar_imu = motion(rotation(-0.8, -0.1, 0.05), {-0.8, 0.32, -0.81});
  rig.T_imu_lidar = T_lidar_imu.inverse();
  Eigen::Matrix3d R_axes;  // forward, left, up -> right, down, forward
  R_axes << 0, -1, 0, 0, 0, -1, 1, 0, 0;
  rig.T_cam0_lidar = motion(rotation(0.6, 0.4, -0.5) * R_axes, {-0.005, -0.075, -0.27});
  rig.R_rect = rotation(-0.25, -0.3, 0.35);

  const Eigen::Matrix3d R_error =
      exp_se3((Twist() << options.camera.rotation_error, 0, 0, 0).finished()).linear();
  for (const SimulatedCamera& simulated : options.camera.cameras) {
    const Eigen::Vector3d t = camera_translation(simulated);
    Camera camera;
    camera.index = simulated.number;
    camera.width = options.camera.width;
    camera.height = options.camera.height;
    camera.fx = camera.fy = options.camera.focal;
    camera.cx = options.camera.cx;
    camera.cy = options.camera.cy;
    camera.T_cam_lidar = Eigen::Translation3d(t) *
                         motion(R_error * rig.R_rect, Eigen::Vector3d::Zero()) * rig.T_cam0_lidar;
    rig.cameras.push_back(camera);
    rig.t.push_back(t);
  }
  return rig;
}

}  // namespace fovea
