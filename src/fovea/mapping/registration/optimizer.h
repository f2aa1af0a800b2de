// The optimiser of all registration methods: Gauss-Newton / Levenberg-Marquardt on SE(3).
#pragma once

#include "fovea/mapping/registration/pair_equations.h"

namespace fovea {

struct OptimizerOptions {
  double robust_width = 0;           ///< Geman-McClure width (m), 0: off
  double degenerate_eigenvalue = 0;  ///< information a pair below which a direction is left alone
  bool judge_by_planes = false;      ///< that information is H_planes (pairs have normals), not H
  double converged_rotation = 1e-4;  ///< rad
  double converged_translation = 1e-3;  ///< m
};

/// Unit of rotations beside translations: one radian counts like this many metres, the distance at
/// which a LiDAR's points typically lie, so that the eigenvalues of both can share one threshold.
inline constexpr double kRotationArm = 10.0;

struct OptimizerResult {
  RigidMotion T_target_source = RigidMotion::Identity();
  int degenerate_directions = 0;
  PairEquations equations;  ///< at T_target_source
};

/// Minimises the error of fixed pairs. A step that raises the error is not taken but damped and
/// tried again; directions of too little information are projected out of every step ("solution
/// remapping", Zhang, Kaess, Singh, ICRA 2016), so that the pose keeps its first value along them.
OptimizerResult minimize(const PairBlocks& pairs, const RigidMotion& guess,
                         const OptimizerOptions& options);

}  // namespace fovea
