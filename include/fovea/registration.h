// Registration of a scan to another one or to a map (paper: Pose Refinement; docs/method.md 2).
#pragma once

#include <cstddef>
#include <optional>

#include "fovea/point_cloud.h"
#include "fovea/rigid_motion.h"

namespace fovea {

/// What makes registration faster and more robust than the textbook loop. All are on by default;
/// tests and measurements switch single ones off. Without a robust kernel only the pair cache has
/// an effect.
struct RegistrationPolicies {
  bool narrowing_kernel = true;
  bool coarse_phase = true;
  bool pair_cache = true;
  bool aitken_acceleration = true;
};

enum class RegistrationMethod { kGicp, kPointToPoint, kPointToPlane };

struct RegistrationOptions {
  RegistrationMethod method = RegistrationMethod::kGicp;
  int max_iterations = 100;             ///< point to point needs dozens, the other methods a few
  int max_points = 0;                   ///< points kept of a cloud, at even steps; 0: all
  double max_distance = 1.0;            ///< m, pairs further apart are not used
  double converged_rotation = 1e-4;     ///< rad; a smaller step ends the iteration
  double converged_translation = 1e-3;  ///< m
  int neighbors = 10;                   ///< k of the local covariance (normals, GICP)
  double plane_epsilon = 1e-3;          ///< GICP: variance along the normal over that in the plane
  /// Width of the robust kernel (Geman-McClure) in m; 0 switches it off.
  double robust_width = 0.0;
  /// A direction of motion is degenerate if its information from the target's planes is less than
  /// this, per pair. Information is the mean square change of the distance to the plane, per meter
  /// moved or tenth of a radian turned about the sensor. The weakest direction has 0.1 or more in a
  /// street and 0.0025 in a featureless corridor (noise of the normals). Without normals (point to
  /// point) no direction is degenerate.
  double degenerate_eigenvalue = 0.01;
  RegistrationPolicies policies = {};
};

/// An estimate of the pose that does not use the scan.
struct PosePrior {
  RigidMotion T_target_source = RigidMotion::Identity();
  /// Standard deviations of a twist of the source about its own origin: rad, m.
  Twist sigma = Twist::Ones();
};

struct RegistrationResult {
  RigidMotion T_target_source = RigidMotion::Identity();
  bool converged = false;
  int iterations = 0;
  std::size_t searches = 0;       ///< nearest-neighbor searches in all iterations
  std::size_t pairs = 0;          ///< in the last iteration
  double rms_distance = 0;        ///< m, of the last iteration's pairs
  int degenerate_directions = 0;  ///< of six; the pairs do not move the pose along them
  /// Information matrix of a twist of the source about its own origin, 1/rad^2, 1/m^2. It treats
  /// the pairs as independent, so it is too optimistic.
  Eigen::Matrix<double, 6, 6> information = Eigen::Matrix<double, 6, 6>::Zero();
};

/// Aligns a scan to another one from a first guess by iterative closest point.
///
///   RegistrationOptions options;
///   options.robust_width = 0.1;
///   const RegistrationResult result = register_scans(first, second, RigidMotion::Identity(),
///   options); if (result.converged) use(result.T_target_source);
///
/// The result is the same at any number of threads. Data cause no exception: with fewer than 50
/// pairs the result is not converged, T_target_source is the guess, and all six directions are
/// degenerate.
/// @param target, source  m, in the frame of their sensor; within some 100 m of it floats are
///                        precise enough. Points that are not finite are left out
/// @param guess           T_target_source, within max_distance of the truth
/// @param prior           of the pose, for example from navigation
FOVEA_API RegistrationResult register_scans(const PointCloud& target, const PointCloud& source,
                                            const RigidMotion& guess,
                                            const RegistrationOptions& options = {},
                                            const std::optional<PosePrior>& prior = std::nullopt);

}  // namespace fovea
