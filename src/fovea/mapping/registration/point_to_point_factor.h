// Iterative closest point (Besl, McKay 1992): point to point.
#pragma once

#include "fovea/mapping/registration/pair_equations.h"
#include "fovea/mapping/registration/registration.h"

namespace fovea {

/// The error is |d|^2. Without normals, the sampling of a wall pulls along the wall, and no
/// direction is degenerate.
struct PointToPointFactor {
  static constexpr bool kNeedsNormals = false;
  static constexpr bool kNeedsSourceNormals = false;
  /// Another target point changes the equations: pairs are never reused.
  static constexpr double kMaxPairMove = 0;  // m, see PairCache

  static Symmetric3 information(const Eigen::Vector3f&, const Eigen::Vector3f&,
                                const RegistrationOptions&) {
    return pack_symmetric(Eigen::Matrix3f::Identity());
  }
};

}  // namespace fovea
