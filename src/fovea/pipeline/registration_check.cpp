#include "fovea/pipeline/registration_check.h"

#include <fmt/format.h>

#include <numbers>

namespace fovea {

AlignmentStats alignment_stats(const RegistrationResult& result, const RigidMotion& correction) {
  AlignmentStats stats;
  stats.iterations = result.iterations;
  stats.pairs = result.pairs;
  stats.rms_m = result.rms_distance;
  stats.degenerate_directions = result.degenerate_directions;
  stats.correction_m = correction.translation().norm();
  stats.correction_rad = rotation_angle(correction.linear());
  return stats;
}

std::string failure_of(const RegistrationResult& result, const AlignmentStats& alignment,
                       const CorrectionLimits& limits) {
  if (!result.converged) return "registration did not converge, first guess kept";
  if (alignment.correction_m <= limits.translation_m &&
      alignment.correction_rad <= limits.rotation_rad) {
    return "";
  }
  return fmt::format("registration moved {:.2f} m and {:.1f} degrees, first guess kept",
                     alignment.correction_m, alignment.correction_rad * 180 / std::numbers::pi);
}

}  // namespace fovea
