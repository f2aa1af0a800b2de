// Registration of two clouds that may show the same place.
#pragma once

#include <cmath>
#include <optional>

#include "fovea/mapping/registration/registration.h"

namespace fovea {

/// Largest error of a guess, m.
inline constexpr double kPlaceReach = 5;

/// Whether a normal is that of a vertical surface. The ground does not distinguish places.
/// @param normal  z up; zero if unknown
inline bool is_vertical(const Eigen::Vector3f& normal) {
  constexpr float kFlat = 0.7f;  // least |z| of a ground normal
  return !normal.isZero() && std::abs(normal.z()) <= kFlat;
}

/// Fit of the vertical surfaces; ground fits anywhere.
struct PlaceFit {
  std::size_t vertical = 0;  ///< points on vertical surfaces
  double overlap = 0;        ///< share of them with a counterpart in the target
  double on_plane = 0;       ///< share of the paired ones on their counterpart's plane
};
/// Limits for a counterpart and for a point on its plane.
struct PlaceFitOptions {
  float pair_distance = 1;  ///< m
  float on_plane = 0.1f;    ///< m
  float alike = 0;          ///< least cosine of the two normals
};
/// @param target, source  with normals, z up; the index is of the target's points
PlaceFit place_fit(const RegistrationCloud& target, const PointIndex& target_index,
                   const RegistrationCloud& source, const RigidMotion& T_target_source,
                   const PlaceFitOptions& options = {});

/// Registers a cloud to another one that may show the same place, from a poor guess. Empty unless
/// all directions are constrained and the vertical surfaces fit as well as those of consecutive
/// scans.
/// @param target   with normals; the index is of its points, z up
/// @param options  of generalized ICP
std::optional<RegistrationResult> match_place(const RegistrationCloud& target,
                                              const PointIndex& target_index,
                                              const RegistrationCloud& source,
                                              const RigidMotion& guess_T_target_source,
                                              const RegistrationOptions& options);

}  // namespace fovea
