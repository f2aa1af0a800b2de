// Iterative closest point (Chen, Medioni 1992): point to plane.
#pragma once

#include "fovea/mapping/registration/pair_equations.h"
#include "fovea/mapping/registration/registration.h"

namespace fovea {

/// The error is the squared distance to the target's plane, (n^T d)^2. A target point without a
/// normal gives no pair.
struct PointToPlaneFactor {
  static constexpr bool kNeedsNormals = true;
  static constexpr bool kNeedsSourceNormals = false;
  /// Another target point on the same plane gives nearly the same equations.
  static constexpr double kMaxPairMove = 0.01;  // m, see PairCache

  /// @param n  unit normal of the target point, or zero
  static Symmetric3 information(const Eigen::Vector3f& n, const Eigen::Vector3f&,
                                const RegistrationOptions&) {
    return pack_symmetric(n * n.transpose());
  }
};

}  // namespace fovea
