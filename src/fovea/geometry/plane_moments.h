// Planes through points near one place: sums over them, and the direction of least variance.
#pragma once

#include <Eigen/Core>
#include <array>

#include "fovea/core/lanes.h"
#include "fovea/platform.h"

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
  Eigen::Matrix3f covariance() const;
};

/// Symmetric matrices, eight side by side.
struct SymmetricLanes {
  Lanes xx{}, yy{}, zz{}, yz{}, xz{}, xy{};

  void put(int lane, const Eigen::Matrix3f& m) {
    xx[lane] = m(0, 0);
    yy[lane] = m(1, 1);
    zz[lane] = m(2, 2);
    yz[lane] = m(1, 2);
    xz[lane] = m(0, 2);
    xy[lane] = m(0, 1);
  }
  Eigen::Matrix3f matrix(int lane) const {
    Eigen::Matrix3f m;
    m << xx[lane], xy[lane], xz[lane], xy[lane], yy[lane], yz[lane], xz[lane], yz[lane], zz[lane];
    return m;
  }
  Lanes trace() const { return xx + yy + zz; }
  SymmetricLanes operator*(const Lanes& factor) const {
    return {xx * factor, yy * factor, zz * factor, yz * factor, xz * factor, xy * factor};
  }
  SymmetricLanes squared() const {
    return {xx * xx + xy * xy + xz * xz, xy * xy + yy * yy + yz * yz, xz * xz + yz * yz + zz * zz,
            xy * xz + yy * yz + yz * zz, xx * xz + xy * yz + xz * zz, xx * xy + xy * yy + xz * yz};
  }
  /// The inverse but for a factor, and there where the matrix is singular, too.
  SymmetricLanes adjugate() const {
    return {yy * zz - yz * yz, xx * zz - xz * xz, xx * yy - xy * xy,
            xz * xy - xx * yz, xy * yz - xz * yy, xz * yz - xy * zz};
  }
};

/// Sums over points around eight places, side by side.
struct MomentLanes {
  Lanes count{};
  std::array<Lanes, 3> sum{}, squares{}, products{};  // as in PlaneMoments

  void put(int lane, const PlaneMoments& moments) {
    count[lane] = moments.count;
    for (std::size_t i = 0; i < 3; ++i) {
      sum[i][lane] = moments.sum[Eigen::Index(i)];
      squares[i][lane] = moments.squares[Eigen::Index(i)];
      products[i][lane] = moments.products[Eigen::Index(i)];
    }
  }

  /// Of those that have a point.
  SymmetricLanes covariance() const {
    const Lanes x = sum[0] / count, y = sum[1] / count, z = sum[2] / count;
    return {squares[0] / count - x * x,  squares[1] / count - y * y,  squares[2] / count - z * z,
            products[0] / count - y * z, products[1] / count - x * z, products[2] / count - x * y};
  }
};

inline Eigen::Matrix3f PlaneMoments::covariance() const {
  MomentLanes lanes;
  lanes.put(0, *this);
  return lanes.covariance().matrix(0);
}

/// Of eight covariances, a row for each coordinate: unit, of either sign; zero where the points are
/// one, or lie on one line: there is no plane then. A lane's bits do not depend on the others.
std::array<Lanes, 3> directions_of_least_variance(const SymmetricLanes& covariance);

/// Of one covariance.
Eigen::Vector3f direction_of_least_variance(const Eigen::Matrix3f& covariance);

}  // namespace fovea
