// The optimiser of all registration methods: Gauss-Newton / Levenberg-Marquardt on SE(3).
#pragma once

#include <optional>

#include "fovea/mapping/registration/pair_equations.h"

namespace fovea {

/// What is known of a pose without the scan.
struct PosePrior {
  RigidMotion T_target_source = RigidMotion::Identity();
  /// Standard deviations of a twist of the source about its own origin: rad, m.
  Twist sigma = Twist::Ones();
};

struct OptimizerOptions {
  double robust_width = 0;           ///< Geman-McClure width (m), 0: off
  double degenerate_eigenvalue = 0;  ///< information a pair below which a direction is left alone
  bool judge_by_planes = false;      ///< that information is H_planes (pairs have normals), not H
  double converged_rotation = 1e-4;  ///< rad
  double converged_translation = 1e-3;  ///< m
  std::optional<PosePrior> prior = std::nullopt;
};

/// Unit of rotations beside translations: one radian counts like this many metres, the distance at
/// which a LiDAR's points typically lie, so that the eigenvalues of both can share one threshold.
inline constexpr double kRotationArm = 10.0;

struct OptimizerResult {
  RigidMotion T_target_source = RigidMotion::Identity();
  int degenerate_directions = 0;
  PairEquations equations;  ///< at T_target_source
};

/// Minimizes the error of fixed pairs and of the prior.
///
/// A step that raises the error is not taken but damped and tried again. Pairs do not count in
/// directions of too little information ("solution remapping", Zhang, Kaess, Singh, ICRA 2016):
/// there the pose follows the prior, or keeps its first value without one. The errors of pairs have
/// much in common: all pairs together count as a hundred independent ones beside the prior.
OptimizerResult minimize(const PairBlocks& pairs, const RigidMotion& guess,
                         const OptimizerOptions& options);

}  // namespace fovea
