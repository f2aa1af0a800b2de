#include "fovea/simulation/rig.h"

#include <cmath>
#include <numbers>
#include <string>

#include "fovea/core/angle.h"
#include "fovea/errors.h"
#include "fovea/geometry/rectified_camera.h"
#include "fovea/rigid_motion.h"

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

Eigen::Matrix3d mounting(const LidarOptions& lidar) {
  return rotation(lidar.roll / kDegree, lidar.pitch / kDegree, lidar.yaw / kDegree);
}

/// KITTI's rectified cameras look the same way from places that differ mostly sideways.
Eigen::Vector3d camera_translation(const SimulatedCamera& camera) {
  if (camera.number == 0) return {-camera.right, 0, -camera.forward};
  return {-camera.right, 0.001 * (camera.number - 2.5), 0.003 - camera.forward};
}

Lens make_lens(SimulatedLens lens) {
  switch (lens) {
    case SimulatedLens::kNone:
      break;
    case SimulatedLens::kPlumbBob:
      return {LensModel::kPlumbBob, {-0.28, 0.07, 0.0005, -0.0004, -0.005}};
    case SimulatedLens::kRational:
      return {LensModel::kRationalPolynomial, {0.2, 0.05, 0.0005, -0.0004, 0.001, 0.5, 0.1, 0.005}};
    case SimulatedLens::kFisheye:
      return {LensModel::kEquidistant, {-0.012, 0.004, -0.002, 0.0003}};
  }
  return {};
}

/// As the readers of a drive do by default (docs/drives.md).
constexpr double kMaxFieldOfView = 100 * kDegree;
constexpr int kMaxSide = 8192;

}  // namespace

LensCamera lens_camera(const SimulatedCamera& camera, const CameraOptions& options) {
  return {options.width, options.height, options.focal,         options.focal,
          options.cx,    options.cy,     make_lens(camera.lens)};
}

std::vector<SimulatedCamera> rig_cameras(CameraRig rig) {
  if (rig == CameraRig::kKitti) return {kitti_camera(2), kitti_camera(3)};
  constexpr int kCount = 5;
  constexpr double kRadius = 0.35;       // m, round the LiDAR
  constexpr double kLidarBehind = 0.27;  // m, behind camera 0
  std::vector<SimulatedCamera> cameras;
  for (int k = 0; k < kCount; ++k) {
    SimulatedCamera camera;
    camera.number = k;
    camera.yaw = std::remainder(2 * std::numbers::pi * k / kCount, 2 * std::numbers::pi);
    camera.right = -kRadius * std::sin(camera.yaw);
    camera.forward = kRadius * std::cos(camera.yaw) - kLidarBehind;
    cameras.push_back(camera);
  }
  cameras[1].lens = SimulatedLens::kFisheye;
  cameras[4].lens = SimulatedLens::kPlumbBob;
  return cameras;
}

SimulatedCamera kitti_camera(int number) {
  switch (number) {
    case 0:
      return {0, 0, true};
    case 1:
      return {1, 0.54, true};
    case 2:
      return {2, -0.06, false};
    case 3:
      return {3, 0.473, false};
    default:
      return {number, 0, false};
  }
}

Rig make_rig(const SimulationOptions& options) {
  Rig rig;
  // The other sensors keep their places where the LiDAR is turned.
  const LidarOptions& lidar = options.lidar;
  const RigidMotion T_upright_lidar = motion(mounting(lidar), Eigen::Vector3d::Zero());
  for (const FurtherLidarOptions& further : options.further_lidars) {
    const Eigen::Vector3d t(further.forward, further.left, further.lidar.height - lidar.height);
    rig.T_lidar_further.push_back(T_upright_lidar.inverse() * motion(mounting(further.lidar), t));
  }
  rig.T_vehicle_lidar = motion(rotation(0.15, 0.25, -0.2), {0, 0, lidar.height}) * T_upright_lidar;
  // The IMU sits behind, to the left of and below the LiDAR.
  const RigidMotion T_upright_imu = motion(rotation(-0.8, -0.1, 0.05), {-0.8, 0.32, -0.81});
  rig.T_imu_lidar = T_upright_imu.inverse() * T_upright_lidar;
  Eigen::Matrix3d R_axes;  // forward, left, up -> right, down, forward
  R_axes << 0, -1, 0, 0, 0, -1, 1, 0, 0;
  const ImuOptions& imu = options.imu;
  rig.T_lidar_imu_calibrated =
      T_upright_lidar.inverse() *
      motion(rotation(imu.roll / kDegree, imu.pitch / kDegree, imu.yaw / kDegree),
             {imu.forward, imu.left, imu.up});
  rig.T_lidar_imu =
      rig.T_lidar_imu_calibrated * exp_se3((Twist() << imu.rotation_error, 0, 0, 0).finished());
  rig.T_cam0_lidar =
      motion(rotation(0.6, 0.4, -0.5) * R_axes, {-0.005, -0.075, -0.27}) * T_upright_lidar;
  rig.R_rect = rotation(-0.25, -0.3, 0.35);

  const Eigen::Matrix3d R_error =
      exp_se3((Twist() << options.camera.rotation_error, 0, 0, 0).finished()).linear();
  for (const SimulatedCamera& simulated : options.camera.cameras) {
    const Eigen::Vector3d t = camera_translation(simulated);
    const LensCamera optics = lens_camera(simulated, options.camera);
    const auto rectified = rectified_camera(optics, kMaxFieldOfView, kMaxSide);
    if (!rectified) {
      throw ConfigError("the lens leaves no image, or one too large",
                        "camera.lens_" + std::to_string(simulated.number),
                        "give another camera.focal or size");
    }
    Camera camera = *rectified;
    camera.index = simulated.number;
    // The camera's y axis points down.
    const Eigen::AngleAxisd R_turned_straight(simulated.yaw, Eigen::Vector3d::UnitY());
    const auto T_cam_lidar = [&](const Eigen::Matrix3d& R, const Eigen::Vector3d& moved) {
      return RigidMotion(R_turned_straight * Eigen::Translation3d(t) * motion(R, moved) *
                         rig.T_cam0_lidar);
    };
    camera.T_cam_lidar = T_cam_lidar(R_error * rig.R_rect, options.camera.translation_error);
    rig.T_cam_lidar_calibrated.push_back(T_cam_lidar(rig.R_rect, Eigen::Vector3d::Zero()));
    rig.cameras.push_back(camera);
    rig.optics.push_back(optics);
    rig.t.push_back(t);
  }
  return rig;
}

}  // namespace fovea
