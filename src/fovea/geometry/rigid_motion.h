// Rigid motions SE(3). `T_a_b` maps points of frame b into frame a.
#pragma once

#include <Eigen/Geometry>

#include "fovea/core/eigen_alignment.h"

namespace fovea {

using RigidMotion = Eigen::Isometry3d;

/// Tangent of SE(3): rotation vector (rad) first, then translation (m).
using Twist = Eigen::Matrix<double, 6, 1>;

/// Cross-product matrix: hat(a) * b == a x b.
Eigen::Matrix3d hat(const Eigen::Vector3d& v);

/// Exponential and logarithm of SE(3): exp(log(T)) == T for rotations below pi.
RigidMotion exp_se3(const Twist& twist);
Twist log_se3(const RigidMotion& T);

/// The twist of a rigid body in frame a as one of its parts in frame b, which is fixed to it, has
/// it.
Twist twist_of_part(const Twist& twist_a, const RigidMotion& T_a_b);

/// Constant-twist interpolation from T0 (s = 0) to T1 (s = 1); s outside [0, 1] extrapolates.
RigidMotion interpolate(const RigidMotion& T0, const RigidMotion& T1, double s);

/// Twist per second, in its own frame, of a body that moves from T0 to T1 in `elapsed` s.
Twist velocity_between(const RigidMotion& T0, const RigidMotion& T1, double elapsed);

/// Angle of the rotation, rad in [0, pi].
double rotation_angle(const Eigen::Matrix3d& R);

/// Whether R is orthonormal with determinant 1, every entry of R^T R within `tolerance`.
bool is_rotation(const Eigen::Matrix3d& R, double tolerance);

/// The nearest rotation (Frobenius norm): takes the rounding out of a matrix read from text.
Eigen::Matrix3d nearest_rotation(const Eigen::Matrix3d& R);

}  // namespace fovea
