// Rigid motions in the numbers that tables, configuration files and ROS messages hold.
#pragma once

#include "fovea/rigid_motion.h"

namespace fovea {

/// p_a = rotation * p_b + translation, for T_a_b. Kept where numbers must come out as they went in:
/// the way to a matrix and back changes last digits.
struct QuaternionMotion {
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();  ///< unit, but for rounding

  QuaternionMotion() = default;
  QuaternionMotion(const Eigen::Vector3d& t, const Eigen::Quaterniond& q)
      : translation(t), rotation(q) {}
  // Implicit: a motion is one, however it is written down.
  QuaternionMotion(const RigidMotion& T) : translation(T.translation()), rotation(T.linear()) {}

  RigidMotion matrix() const {
    RigidMotion T(rotation.normalized());
    T.pretranslate(translation);
    return T;
  }
  QuaternionMotion inverse() const {
    const Eigen::Quaterniond back = rotation.conjugate();
    return {back * -translation, back};
  }
  /// T_a_b * T_b_c = T_a_c.
  QuaternionMotion operator*(const QuaternionMotion& other) const {
    return {translation + rotation * other.translation, rotation * other.rotation};
  }
};

/// From T0 (s = 0) to T1 (s = 1), translation and rotation each at constant speed; at 0 and 1 their
/// very numbers.
inline QuaternionMotion interpolate(const QuaternionMotion& T0, const QuaternionMotion& T1,
                                    double s) {
  if (s <= 0) return T0;
  if (s >= 1) return T1;
  return {T0.translation + s * (T1.translation - T0.translation),
          T0.rotation.slerp(s, T1.rotation)};
}

}  // namespace fovea
