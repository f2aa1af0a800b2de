// Planes through points near one place: sums over them, and the direction of least variance.
#pragma once

#include <Eigen/Geometry>

namespace fovea {

/// Sums over points around one of them, which is near: squares of coordinates near 100 m would
/// cancel.
struct PlaneMoments {
  float count = 0;
  Eigen::Vector3f sum = Eigen::Vector3f::Zero();
  Eigen::Vector3f squares = Eigen::Vector3f::Zero();   // xx, yy, zz
  Eigen::Vector3f products = Eigen::Vector3f::Zero();  // yz, xz, xy

  void add(const Eigen::Vector3f& p) {
    count += 1;
    sum += p;
    squares += p.cwiseProduct(p);
    products += Eigen::Vector3f(p.y() * p.z(), p.x() * p.z(), p.x() * p.y());
  }

  /// Of at least one point.
  Eigen::Matrix3f covariance() const {
    const Eigen::Vector3f mean = sum / count;
    const Eigen::Vector3f beside =
        products / count -
        Eigen::Vector3f(mean.y() * mean.z(), mean.x() * mean.z(), mean.x() * mean.y());
    Eigen::Matrix3f covariance;
    covariance.diagonal() = squares / count - mean.cwiseProduct(mean);
    covariance(1, 2) = covariance(2, 1) = beside[0];
    covariance(0, 2) = covariance(2, 0) = beside[1];
    covariance(0, 1) = covariance(1, 0) = beside[2];
    return covariance;
  }
};

/// Unit, of either sign; zero where the points are one, or lie on one line: there is no plane then.
inline Eigen::Vector3f direction_of_least_variance(Eigen::Matrix3f covariance) {
  // No plane, if the second variance is below this share of the first.
  constexpr float kLineRatio = 1e-4f;
  constexpr int kSquarings = 4;  // power iterations: to the 2^4th power
  const float spread = covariance.trace();
  if (!(spread > 0)) return Eigen::Vector3f::Zero();
  covariance /= spread;

  // The adjugate (the inverse but for a factor, and there where the matrix is singular) has the
  // same eigenvectors, and that of the least variance has the largest eigenvalue, the product of
  // the two others. Squaring makes it prevail (power iteration).
  Eigen::Matrix3f power;
  power.col(0) = covariance.col(1).cross(covariance.col(2));
  power.col(1) = covariance.col(2).cross(covariance.col(0));
  power.col(2) = covariance.col(0).cross(covariance.col(1));
  const float area = power.trace();
  if (!(area > kLineRatio)) return Eigen::Vector3f::Zero();
  power /= area;
  for (int i = 0; i < kSquarings; ++i) {
    power = (power * power).eval();
    power /= power.trace();
  }
  Eigen::Index widest = 0;
  power.diagonal().maxCoeff(&widest);
  return power.col(widest).normalized();
}

}  // namespace fovea
