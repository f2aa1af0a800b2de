// Limits that the check and the estimate of a camera share.
#pragma once

#include <cstddef>

#include "fovea/core/angle.h"

namespace fovea {

/// Fewer edges show nothing.
inline constexpr std::size_t kMinEdges = 200;
/// Largest standard deviations of observable values: rad, m, s.
inline constexpr double kMaxRotationSigma = 0.15 * kDegree, kMaxTranslationSigma = 0.02,
                        kMaxDelaySigma = 0.004;
/// Errors that all edges of a drive may share, such as those of beams or of the lens: pixels, rms.
inline constexpr double kSystematicError = 0.1;

}  // namespace fovea
