// Twists and their covariances in another frame. Private to merging/.
#pragma once

#include "fovea/rigid_motion.h"

namespace fovea {

/// Turns twists in frame b into those of the same motion in frame a: a covariance of twists is
/// adjoint * covariance * adjoint^T there.
inline Eigen::Matrix<double, 6, 6> adjoint(const RigidMotion& T_a_b) {
  Eigen::Matrix<double, 6, 6> adjoint = Eigen::Matrix<double, 6, 6>::Zero();
  adjoint.topLeftCorner<3, 3>() = adjoint.bottomRightCorner<3, 3>() = T_a_b.linear();
  adjoint.bottomLeftCorner<3, 3>() = hat(T_a_b.translation()) * T_a_b.linear();
  return adjoint;
}

}  // namespace fovea
