#include "fovea/rigid_motion.h"

#include <Eigen/SVD>
#include <cmath>

namespace fovea {
namespace {

/// Left Jacobian of SO(3): the translation of exp_se3([w, v]) is J(w) * v.
Eigen::Matrix3d left_jacobian(const Eigen::Vector3d& w) {
  const double angle2 = w.squaredNorm();
  const Eigen::Matrix3d W = hat(w);
  if (angle2 < 1e-8) {  // Taylor: the exact form divides by angle^3
    return Eigen::Matrix3d::Identity() + 0.5 * W + (1.0 / 6.0) * W * W;
  }
  const double angle = std::sqrt(angle2);
  return Eigen::Matrix3d::Identity() + (1 - std::cos(angle)) / angle2 * W +
         (angle - std::sin(angle)) / (angle2 * angle) * W * W;
}

}  // namespace

Eigen::Matrix3d hat(const Eigen::Vector3d& v) {
  Eigen::Matrix3d m;
  m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return m;
}

RigidMotion exp_se3(const Twist& twist) {
  const Eigen::Vector3d w = twist.head<3>();
  const double angle = w.norm();
  RigidMotion T = RigidMotion::Identity();
  if (angle > 0) T.linear() = Eigen::AngleAxisd(angle, w / angle).toRotationMatrix();
  T.translation() = left_jacobian(w) * twist.tail<3>();
  return T;
}

Twist log_se3(const RigidMotion& T) {
  // By way of the quaternion, which stays accurate at small angles and near pi.
  Eigen::Quaterniond q(T.linear());
  q.normalize();
  if (q.w() < 0) q.coeffs() = -q.coeffs();
  const double s = q.vec().norm();
  const double angle = 2 * std::atan2(s, q.w());
  Twist twist;
  twist.head<3>() =
      s > 1e-12 ? Eigen::Vector3d(q.vec() * (angle / s)) : Eigen::Vector3d(2 * q.vec());
  twist.tail<3>() =
      left_jacobian(twist.head<3>()).partialPivLu().solve(Eigen::Vector3d(T.translation()));
  return twist;
}

Twist twist_of_part(const Twist& twist_a, const RigidMotion& T_a_b) {
  const Eigen::Matrix3d R_b_a = T_a_b.linear().transpose();
  const Eigen::Vector3d w_a = twist_a.head<3>(), v_a = twist_a.tail<3>();
  Twist twist_b;
  twist_b.head<3>() = R_b_a * w_a;
  twist_b.tail<3>() = R_b_a * (v_a + w_a.cross(T_a_b.translation()));
  return twist_b;
}

RigidMotion interpolate(const RigidMotion& T0, const RigidMotion& T1, double s) {
  return T0 * exp_se3(s * log_se3(T0.inverse() * T1));
}

Twist velocity_between(const RigidMotion& T0, const RigidMotion& T1, double elapsed) {
  return log_se3(T0.inverse() * T1) / elapsed;
}

double rotation_angle(const Eigen::Matrix3d& R) { return Eigen::AngleAxisd(R).angle(); }

bool is_rotation(const Eigen::Matrix3d& R, double tolerance) {
  return R.allFinite() && R.determinant() > 0 &&
         (R.transpose() * R - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff() <= tolerance;
}

Eigen::Matrix3d nearest_rotation(const Eigen::Matrix3d& R) {
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(R, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Matrix3d U = svd.matrixU();
  if ((U * svd.matrixV().transpose()).determinant() < 0) U.col(2) = -U.col(2);
  return U * svd.matrixV().transpose();
}

}  // namespace fovea
