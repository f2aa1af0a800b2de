// Whether two clouds show one place, and how they lie to each other.
#pragma once

#include <optional>

#include "fovea/mapping/registration/registration.h"

namespace fovea {

/// How far off a guess may be, m.
inline constexpr double kPlaceReach = 5;

/// Registers a cloud to another one that may show the same place, from a poor guess; nothing unless
/// all directions are known and what stands on the ground there fits as well as neighbouring scans
/// do. Ground alone fits anywhere.
/// @param target   with normals; the index is of its points, z up
/// @param options  of generalised ICP
std::optional<RigidMotion> match_place(const RegistrationCloud& target,
                                       const PointIndex& target_index,
                                       const RegistrationCloud& source,
                                       const RigidMotion& guess_T_target_source,
                                       const RegistrationOptions& options);

}  // namespace fovea
