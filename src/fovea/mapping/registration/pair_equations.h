// What every registration factor shares: a pair of points, its error and its normal equations.
#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "fovea/geometry/rigid_motion.h"

namespace fovea {

/// Symmetric 3x3 matrix: xx, xy, xz, yy, yz, zz.
using Symmetric3 = Eigen::Matrix<float, 6, 1>;

inline Symmetric3 pack_symmetric(const Eigen::Matrix3f& m) {
  Symmetric3 packed;
  packed << m(0, 0), m(0, 1), m(0, 2), m(1, 1), m(1, 2), m(2, 2);
  return packed;
}

inline Eigen::Matrix3d unpack_symmetric(const Symmetric3& s) {
  const Eigen::Matrix<double, 6, 1> d = s.cast<double>();
  Eigen::Matrix3d m;
  m << d[0], d[1], d[2], d[1], d[3], d[4], d[2], d[4], d[5];
  return m;
}

/// A source point, its nearest target point, and what a factor says of them. A factor is a struct
/// with
///   static Symmetric3 information(target_normal, source_normal_in_target, options)
/// the matrix M (target axes) of the pair's squared error d^T M d, d = T * source - target. M is
/// scaled so that a fully trusted direction counts 1: the error is in m^2 with every method. M
/// stays as it is while the pair does, which makes the error of a set of pairs a plain function of
/// T.
struct Pair {
  static constexpr std::uint32_t kNone = 0xffffffff;
  Eigen::Vector3f source;
  Eigen::Vector3f target;
  Symmetric3 information;
  Eigen::Vector3f normal = Eigen::Vector3f::Zero();  // the target's; zero where unknown or unused
  std::uint32_t target_index = kNone;
};

/// Gauss-Newton normal equations, H * step = -b, of a set of pairs.
///
/// The pose is perturbed on the right, T * exp(step), rotation first: the step is a twist about the
/// source's own origin (the sensor), so that rotation and translation are conditioned alike
/// wherever the target's origin lies.
struct PairEquations {
  Eigen::Matrix<double, 6, 6> H = Eigen::Matrix<double, 6, 6>::Zero();
  Twist b = Twist::Zero();
  /// H of the target's planes alone (M = n n^T): what the scene's shape can tell, whatever the
  /// method. Degeneracy is judged by it; GICP's H holds its regularisation too, and shrinks where
  /// pairs are wrong, as they all are at a poor first guess.
  Eigen::Matrix<double, 6, 6> H_planes = Eigen::Matrix<double, 6, 6>::Zero();
  double error = 0;             ///< sum of robust squared errors (m^2)
  double squared_distance = 0;  ///< sum of |T * source - target|^2 (m^2)
  double weight = 0;            ///< sum of robust weights
  std::size_t pairs = 0;

  PairEquations& operator+=(const PairEquations& other);

  /// Adds one pair at pose T. Until rotate() the rows stand for the same perturbation expressed in
  /// target axes, which costs no rotation of M a pair.
  void add(const Pair& pair, const RigidMotion& T_target_source, double robust_width);

  /// Turns the accumulated rows from target axes into source axes: the right perturbation.
  void rotate(const Eigen::Matrix3d& R_target_source);
};

inline PairEquations& PairEquations::operator+=(const PairEquations& other) {
  H += other.H;
  b += other.b;
  H_planes += other.H_planes;
  error += other.error;
  squared_distance += other.squared_distance;
  weight += other.weight;
  pairs += other.pairs;
  return *this;
}

inline void PairEquations::add(const Pair& pair, const RigidMotion& T_target_source,
                               double robust_width) {
  const Eigen::Vector3d arm = T_target_source.linear() * pair.source.cast<double>();
  const Eigen::Vector3d d = arm + T_target_source.translation() - pair.target.cast<double>();
  const Eigen::Matrix3d M = unpack_symmetric(pair.information);
  const Eigen::Vector3d Md = M * d;
  const double squared_error = d.dot(Md);

  // Geman-McClure: rho(e^2) = w^2 e^2 / (w^2 + e^2), its derivative weighs the pair.
  double robust = 1, rho = squared_error;
  if (robust_width > 0) {
    const double width2 = robust_width * robust_width;
    const double share = width2 / (width2 + squared_error);
    robust = share * share;
    rho = share * squared_error;
  }

  // Jacobian of d in target axes: [-hat(arm), I].
  const Eigen::Matrix3d A = hat(arm);
  const Eigen::Matrix3d AM = A * M;
  H.topLeftCorner<3, 3>() -= robust * AM * A;
  H.topRightCorner<3, 3>() += robust * AM;
  H.bottomRightCorner<3, 3>() += robust * M;
  b.head<3>() += robust * arm.cross(Md);
  b.tail<3>() += robust * Md;

  const Eigen::Vector3d n = pair.normal.cast<double>();
  Twist slope;  // of the distance to the target's plane
  slope.head<3>() = arm.cross(n);
  slope.tail<3>() = n;
  H_planes += robust * slope * slope.transpose();

  error += rho;
  squared_distance += d.squaredNorm();
  weight += robust;
  ++pairs;
}

inline void PairEquations::rotate(const Eigen::Matrix3d& R) {
  const auto rotate_blocks = [&](Eigen::Matrix<double, 6, 6>& m) {
    m.bottomLeftCorner<3, 3>() = m.topRightCorner<3, 3>().transpose();
    for (int i : {0, 3}) {
      for (int j : {0, 3}) {
        m.block<3, 3>(i, j) = (R.transpose() * m.block<3, 3>(i, j) * R).eval();
      }
    }
  };
  rotate_blocks(H);
  rotate_blocks(H_planes);
  b.head<3>() = (R.transpose() * b.head<3>()).eval();
  b.tail<3>() = (R.transpose() * b.tail<3>()).eval();
}

}  // namespace fovea
