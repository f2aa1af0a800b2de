// Correction of a camera's calibration, and how it moves pixels.
#pragma once

#include <Eigen/Core>

#include "fovea/camera.h"

namespace fovea {

/// The right calibration has exp(rotation) * translation * T_cam_lidar and image_delay + delay. The
/// rotation leaves the center of the camera where it is.
struct CameraCorrection {
  Eigen::Vector3d rotation = Eigen::Vector3d::Zero();     ///< rad, in the camera's axes
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();  ///< m, of points in the camera's axes
  double delay = 0;                                       ///< s
};

Camera corrected(const Camera& camera, const CameraCorrection& correction);

/// The correction that has the effect of `first`, then `second`.
CameraCorrection joined(const CameraCorrection& first, const CameraCorrection& second);

/// Parameters of an edge's position: rotation vector (rad) and translation (m) of the camera's
/// correction in its own axes, delay of the image (s), two shifts (pixels). The shifts are no
/// calibration. Edges along a ring shift outwards, since the width of a beam enlarges objects.
/// Edges between rings shift downwards, since a roof ends beyond the last beam that hit it, and the
/// camera is not at the LiDAR.
using CalibrationVector = Eigen::Matrix<double, 9, 1>;
using CalibrationMatrix = Eigen::Matrix<double, 9, 9>;
/// Places of the parameters in a CalibrationVector. The first kCalibrationSize are the calibration.
enum CalibrationParameter {
  kCamRotation = 0,
  kCamTranslation = 3,
  kCamDelay = 6,
  kCalibrationSize = 7,
  kShiftAlongRing = 7,
  kShiftBetweenRings = 8
};

/// Units of the entries of a correction, each worth about a pixel: rad (roll: more), m (forward:
/// more), s, pixels.
const CalibrationVector& calibration_unit();

/// The calibration's part of a vector in calibration_unit()s.
CameraCorrection correction_of(const CalibrationVector& vector);

using PixelJacobian = Eigen::Matrix<double, 2, kCalibrationSize>;
/// Derivative of the pixel of a fixed point by the calibration.
/// @param camera    where it was when it took the image
/// @param p_lidar   the point, in the LiDAR frame at that time
/// @param velocity  of the LiDAR at that time, per second in its own frame
PixelJacobian pixel_jacobian(const Camera& camera, const Eigen::Vector3d& p_lidar,
                             const Twist& velocity);

}  // namespace fovea
