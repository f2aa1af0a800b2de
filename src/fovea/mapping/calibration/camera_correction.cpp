#include "fovea/mapping/calibration/camera_correction.h"

#include "fovea/geometry/rotation_vector.h"

namespace fovea {
namespace {

RigidMotion motion_of(const CameraCorrection& correction) {
  return exp_se3((Twist() << correction.rotation, 0, 0, 0).finished()) *
         Eigen::Translation3d(correction.translation);
}

}  // namespace

Camera corrected(const Camera& camera, const CameraCorrection& correction) {
  Camera right = camera;
  right.T_cam_lidar = motion_of(correction) * camera.T_cam_lidar;
  right.image_delay += correction.delay;
  return right;
}

CameraCorrection joined(const CameraCorrection& first, const CameraCorrection& second) {
  const RigidMotion both = motion_of(second) * motion_of(first);
  return {log_se3(RigidMotion(both.linear())).head<3>(),
          both.linear().transpose() * both.translation(), first.delay + second.delay};
}

const CalibrationVector& calibration_unit() {
  static const CalibrationVector unit =
      (CalibrationVector() << 0.0014, 0.0014, 0.01, 0.02, 0.02, 0.06, 0.01, 1, 1).finished();
  return unit;
}

CameraCorrection correction_of(const CalibrationVector& vector) {
  const CalibrationVector found = vector.cwiseProduct(calibration_unit());
  return {found.segment<3>(kCamRotation), found.segment<3>(kCamTranslation), found[kCamDelay]};
}

PixelJacobian pixel_jacobian(const Camera& camera, const Eigen::Vector3d& p_lidar,
                             const Twist& velocity) {
  const Eigen::Vector3d p_cam = camera.T_cam_lidar * p_lidar;
  Eigen::Matrix<double, 2, 3> projection;
  const double z = p_cam.z();
  projection << camera.fx / z, 0, -camera.fx * p_cam.x() / (z * z), 0, camera.fy / z,
      -camera.fy * p_cam.y() / (z * z);
  Eigen::Matrix<double, 3, kCalibrationSize> motion;
  motion.middleCols<3>(kCamRotation) = -hat(p_cam);
  motion.middleCols<3>(kCamTranslation).setIdentity();
  motion.col(kCamDelay) =
      -(camera.T_cam_lidar.linear() * (velocity.head<3>().cross(p_lidar) + velocity.tail<3>()));
  return projection * motion;
}

}  // namespace fovea
