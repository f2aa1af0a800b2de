// Whether two clouds show one place, and how they lie to each other.
#pragma once

#include <cmath>
#include <optional>

#include "fovea/mapping/registration/registration.h"

namespace fovea {

/// How far off a guess may be, m.
inline constexpr double kPlaceReach = 5;

/// Whether a point is of something that stands, by its normal: the ground says nothing of a place.
/// @param normal  z up; zero where it is not known
inline bool stands(const Eigen::Vector3f& normal) {
  constexpr float kFlat = 0.7f;  // vertical part of the normal of ground
  return !normal.isZero() && std::abs(normal.z()) <= kFlat;
}

/// How well what stands on the ground fits: ground fits anywhere.
struct PlaceFit {
  std::size_t standing = 0;  ///< points that stand on something
  double overlap = 0;        ///< share of those with a counterpart in the target
  double on_plane = 0;       ///< of those, share on their counterpart's plane
};
/// What counts as a counterpart, and as being on its plane.
struct PlaceFitOptions {
  float pair_distance = 1;  ///< m
  float on_plane = 0.1f;    ///< m
  float alike = 0;          ///< least cosine of the two normals
};
/// @param target, source  with normals, z up; the index is of the target's points
PlaceFit place_fit(const RegistrationCloud& target, const PointIndex& target_index,
                   const RegistrationCloud& source, const RigidMotion& T_target_source,
                   const PlaceFitOptions& options = {});

/// Registers a cloud to another one that may show the same place, from a poor guess; nothing unless
/// all directions are known and what stands on the ground there fits as well as neighbouring scans
/// do.
/// @param target   with normals; the index is of its points, z up
/// @param options  of generalised ICP
std::optional<RegistrationResult> match_place(const RegistrationCloud& target,
                                              const PointIndex& target_index,
                                              const RegistrationCloud& source,
                                              const RigidMotion& guess_T_target_source,
                                              const RegistrationOptions& options);

}  // namespace fovea
