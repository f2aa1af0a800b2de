// Covariance of a registered pose.
#pragma once

#include "fovea/mapping/registration/registration.h"

namespace fovea {

/// Of a twist of the source in its own frame, rotation first (rad^2, m^2). The pairs of a scan
/// have similar errors (normals, bends of the target, calibration): 80 pairs count as one. With
/// this number, covariances equal squared errors on simulated drives (docs/localization.md).
/// @param open  standard deviation along directions that the scene leaves open, m (of turns: at a
///              tenth of a radian)
Eigen::Matrix<double, 6, 6> pose_covariance(const RegistrationResult& registration, double open);

}  // namespace fovea
