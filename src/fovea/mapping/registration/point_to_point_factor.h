// Iterative closest point (Besl, McKay 1992): point to point.
#pragma once

#include "fovea/mapping/registration/pair_equations.h"
#include "fovea/mapping/registration/registration.h"

namespace fovea {

/// Every direction counts alike: the error is |d|^2. Normals are not looked at, so that a wall says
/// where along itself it lies (wrongly: by its sampling), and no direction ever looks degenerate.
struct PointToPointFactor {
  static constexpr bool kNeedsNormals = false;
  static constexpr bool kNeedsSourceNormals = false;
  /// Every pair tells of all directions: it must be of the nearest.
  static constexpr double kKeepsPairFor = 0;  // m

  static Symmetric3 information(const Eigen::Vector3f&, const Eigen::Vector3f&,
                                const RegistrationOptions&) {
    return pack_symmetric(Eigen::Matrix3f::Identity());
  }
};

}  // namespace fovea
