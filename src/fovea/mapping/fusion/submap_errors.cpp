#include "fovea/mapping/fusion/submap_errors.h"

#include "fovea/core/angle.h"

namespace fovea {
namespace {

// The odometry has a constant part, a part per meter, and a part per weak frame.
constexpr double kTranslation = 0.01, kTranslationPerMeter = 0.001, kTranslationPerWeak = 0.1;  // m
constexpr double kRotation = 0.02 * kDegree, kRotationPerMeter = 0.003 * kDegree,
                 kRotationPerWeak = 0.1 * kDegree;
constexpr double kRestartTranslation = 100, kRestartRotation = 90 * kDegree;  // m, rad
constexpr double kLoopTranslation = 0.03, kLoopRotation = 0.05 * kDegree;     // m, rad

Twist deviations(double rotation, double translation) {
  Twist sigma;
  sigma << Eigen::Vector3d::Constant(rotation), Eigen::Vector3d::Constant(translation);
  return sigma;
}

}  // namespace

Twist odometry_deviations(double length, int weak_frames) {
  return deviations(
      kRotation + kRotationPerMeter * length + kRotationPerWeak * weak_frames,
      kTranslation + kTranslationPerMeter * length + kTranslationPerWeak * weak_frames);
}

Twist restart_deviations() { return deviations(kRestartRotation, kRestartTranslation); }

Twist loop_deviations() { return deviations(kLoopRotation, kLoopTranslation); }

}  // namespace fovea
