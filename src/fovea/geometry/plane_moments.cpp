#include "fovea/geometry/plane_moments.h"

namespace fovea {

std::array<Lanes, 3> directions_of_least_variance(const SymmetricLanes& covariance) {
  // No plane, if the second variance is below this share of the first.
  constexpr float kLineRatio = 1e-4f;
  constexpr int kSquarings = 4;  // power iterations: to the 2^4th power
  const Lanes spread = covariance.trace();

  // The adjugate has the same eigenvectors, and that of the least variance has the largest
  // eigenvalue, the product of the two others. Squaring makes it prevail (power iteration).
  SymmetricLanes power = (covariance * (1 / spread)).adjugate();
  const Lanes area = power.trace();
  const LaneMask is_plane = (spread > 0) & (area > kLineRatio);
  power = power * (1 / area);
  for (int i = 0; i < kSquarings; ++i) {
    power = power.squared();
    power = power * (1 / power.trace());
  }
  // The column with the most on the diagonal.
  std::array<Lanes, 3> direction{power.xx, power.xy, power.xz};
  const LaneMask y_over_x = power.yy > power.xx;
  const Lanes widest = y_over_x ? power.yy : power.xx;
  const LaneMask z_over_both = power.zz > widest;
  direction[0] = z_over_both ? power.xz : (y_over_x ? power.xy : direction[0]);
  direction[1] = z_over_both ? power.yz : (y_over_x ? power.yy : direction[1]);
  direction[2] = z_over_both ? power.zz : (y_over_x ? power.yz : direction[2]);
  const Lanes length = sqrt_of(direction[0] * direction[0] + direction[1] * direction[1] +
                               direction[2] * direction[2]);
  for (Lanes& coordinate : direction) coordinate = where(is_plane, coordinate / length);
  return direction;
}

Eigen::Vector3f direction_of_least_variance(const Eigen::Matrix3f& covariance) {
  SymmetricLanes lanes;
  lanes.put(0, covariance);
  const auto [x, y, z] = directions_of_least_variance(lanes);
  return {x[0], y[0], z[0]};
}

}  // namespace fovea
