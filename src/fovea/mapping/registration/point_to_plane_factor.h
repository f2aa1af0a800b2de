// Iterative closest point (Chen, Medioni 1992): point to plane.
#pragma once

#include "fovea/mapping/registration/pair_equations.h"
#include "fovea/mapping/registration/registration.h"

namespace fovea {

/// Only the distance to the target's plane counts: the error is (n^T d)^2. A target point without
/// a normal gives no pair.
struct PointToPlaneFactor {
  static constexpr bool kNeedsNormals = true;
  static constexpr bool kNeedsSourceNormals = false;
  /// Along a wall no pair tells anything, so that it may be of points a little off the nearest.
  static constexpr double kKeepsPairFor = 0.01;  // m

  /// @param n  unit normal of the target point, or zero
  static Symmetric3 information(const Eigen::Vector3f& n, const Eigen::Vector3f&,
                                const RegistrationOptions&) {
    return pack_symmetric(n * n.transpose());
  }
};

}  // namespace fovea
