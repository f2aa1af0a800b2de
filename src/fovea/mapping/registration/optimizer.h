// The optimizer of all registration methods: Levenberg-Marquardt on SE(3).
#pragma once

#include <optional>

#include "fovea/mapping/registration/pair_equations.h"
#include "fovea/mapping/registration/registration_policies.h"
#include "fovea/registration.h"

namespace fovea {

struct OptimizerOptions {
  double robust_width = 0;           ///< Geman-McClure width (m), 0: off
  double degenerate_eigenvalue = 0;  ///< information per pair below which a direction is degenerate
  bool judge_by_planes = false;      ///< information is H_planes (pairs have normals), not H
  StepLimit converged;               ///< smaller steps end the iteration
  std::optional<PosePrior> prior = std::nullopt;
};

/// Meters that one radian is equal to, so that one threshold serves the eigenvalues of rotations
/// and translations. It is the typical distance of a LiDAR's points.
inline constexpr double kRotationArm = 10.0;

/// T * exp(step). Removes the rounding error of the rotation, which would otherwise grow in callers
/// that extrapolate poses.
RigidMotion moved_by(const RigidMotion& T, const Twist& step);

struct OptimizerResult {
  RigidMotion T_target_source = RigidMotion::Identity();
  int degenerate_directions = 0;
  PairEquations equations;  ///< at T_target_source
};

/// Minimizes the error of fixed pairs and of the prior.
///
/// Levenberg-Marquardt: a step that raises the error is damped and tried again. Pairs are ignored
/// in degenerate directions ("solution remapping", Zhang, Kaess, Singh, ICRA 2016): the pose
/// follows the prior there, or keeps its value without a prior. Errors of pairs are correlated:
/// against the prior, all pairs together have the weight of a hundred independent pairs.
OptimizerResult minimize(const PairBlocks& pairs, const RigidMotion& guess,
                         const OptimizerOptions& options);

}  // namespace fovea
