// Rigid motions SE(3). `T_a_b` maps points of frame b into frame a.
#pragma once

#include <Eigen/Geometry>

#include "fovea/platform.h"

namespace fovea {

using RigidMotion = Eigen::Isometry3d;

/// Tangent of SE(3): rotation vector (rad) first, then translation (m).
using Twist = Eigen::Matrix<double, 6, 1>;

/// Cross-product matrix: hat(a) * b == a x b.
FOVEA_API Eigen::Matrix3d hat(const Eigen::Vector3d& v);

/// Exponential and logarithm of SE(3): exp(log(T)) == T for rotations below pi.
FOVEA_API RigidMotion exp_se3(const Twist& twist);
FOVEA_API Twist log_se3(const RigidMotion& T);

/// The twist of a rigid body in frame a as one of its parts in frame b, which is fixed to it, has
/// it.
FOVEA_API Twist twist_of_part(const Twist& twist_a, const RigidMotion& T_a_b);

/// Constant-twist interpolation from T0 (s = 0) to T1 (s = 1); s outside [0, 1] extrapolates.
FOVEA_API RigidMotion interpolate(const RigidMotion& T0, const RigidMotion& T1, double s);

/// Twist per second, in its own frame, of a body that moves from T0 to T1 in `elapsed` s.
FOVEA_API Twist velocity_between(const RigidMotion& T0, const RigidMotion& T1, double elapsed);

/// Angle of the rotation, rad in [0, pi].
FOVEA_API double rotation_angle(const Eigen::Matrix3d& R);

/// Whether R is orthonormal with determinant 1, every entry of R^T R within `tolerance`.
FOVEA_API bool is_rotation(const Eigen::Matrix3d& R, double tolerance = 1e-3);

/// The nearest rotation (Frobenius norm): takes the rounding out of a matrix read from text.
FOVEA_API Eigen::Matrix3d nearest_rotation(const Eigen::Matrix3d& R);

}  // namespace fovea
