// Whether the pose of a registration counts.
#pragma once

#include <string>

#include "fovea/mapping/registration/registration.h"
#include "fovea/pipeline/frame_result.h"

namespace fovea {

/// Largest correction of a first guess by registration.
struct CorrectionLimits {
  double translation_m = 2;
  double rotation_rad = 0.08726646259971647;  // 5 degrees
};

/// @param correction  from the first guess to the registered pose
AlignmentStats alignment_stats(const RegistrationResult& result, const RigidMotion& correction);

/// Why the first guess is better than the registered pose; empty if it is not.
std::string failure_of(const RegistrationResult& result, const AlignmentStats& alignment,
                       const CorrectionLimits& limits = {});

}  // namespace fovea
