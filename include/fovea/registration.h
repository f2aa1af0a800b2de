// Registration of a scan to another one or to a map (paper: Pose Refinement; docs/method.md 2).
#pragma once

#include <cstddef>
#include <optional>

#include "fovea/point_cloud.h"
#include "fovea/rigid_motion.h"

namespace fovea {

/// What makes registration faster and more robust than the textbook loop. Tests and measurements
/// switch single ones off. Without a robust kernel, the default, only the pair cache has an effect.
struct RegistrationPolicies {
  bool narrowing_kernel = true;
  bool coarse_phase = true;
  bool pair_cache = true;
  bool aitken_acceleration = true;
};

enum class RegistrationMethod { kGicp, kPointToPoint, kPointToPlane };

struct RegistrationOptions {
  RegistrationMethod method = RegistrationMethod::kGicp;
  int max_iterations = 100;  ///< point to point needs dozens, the other methods a few
  int max_points = 0;        ///< points kept of a cloud, at even steps; 0: all
  /// m, register_scans() keeps one point in each cell of this edge; 0: all. The rings of a LiDAR on
  /// the ground move with the vehicle. Unthinned, they hold a scan where it is.
  double voxel = 0.25;
  double max_distance = 1.0;            ///< m, pairs further apart are not used
  double converged_rotation = 1e-4;     ///< rad; a smaller step ends the iteration
  double converged_translation = 1e-3;  ///< m
  int neighbors = 10;                   ///< k of the local covariance (normals, GICP)
  double plane_epsilon = 1e-3;          ///< GICP: variance along the normal over that in the plane
  /// Width of the robust kernel (Geman-McClure) in m; 0 switches it off. A narrow one, 0.1 m, is
  /// for guesses that are nearly as close.
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
  bool converged = false;  ///< the steps became small; also in a wrong place (see scan_fit())
  int iterations = 0;
  std::size_t searches = 0;       ///< nearest-neighbor searches in all iterations
  std::size_t pairs = 0;          ///< in the last iteration, of the points that were kept
  double rms_distance = 0;        ///< m, of the last iteration's pairs
  int degenerate_directions = 0;  ///< of six; the pairs do not move the pose along them
  /// Information matrix of a twist of the source about its own origin, 1/rad^2, 1/m^2. It treats
  /// the pairs as independent, so it is too optimistic.
  Eigen::Matrix<double, 6, 6> information = Eigen::Matrix<double, 6, 6>::Zero();
};

/// Aligns a scan to another one from a first guess by iterative closest point.
///
///   const RegistrationResult result = register_scans(first, second);
///   if (scan_fit(first, second, result.T_target_source).shows_one_place()) {
///     use(result.T_target_source);
///   }
///
/// The result is the same at any number of threads. With fewer than 50 pairs it is not converged,
/// T_target_source is the guess, and all six directions are degenerate.
/// @param target, source  m, in the frame of their sensor, origin 0; within some 100 m of it floats
///                        are precise enough. Points that are not finite are left out. Scans of a
///                        moving sensor are compensated first (deskew.h)
/// @param guess           T_target_source; from the identity, scans up to twice max_distance apart
///                        meet in a street
/// @param prior           of the pose, for example from navigation
/// @throws std::invalid_argument  for a scan with another origin, a guess that is no rigid motion,
///                                or an option out of range
FOVEA_API RegistrationResult register_scans(const PointCloud& target, const PointCloud& source,
                                            const RigidMotion& guess = RigidMotion::Identity(),
                                            const RegistrationOptions& options = {},
                                            const std::optional<PosePrior>& prior = std::nullopt);

/// How the vertical surfaces of two scans lie on each other. Ground fits anywhere.
struct FOVEA_API ScanFit {
  std::size_t vertical = 0;  ///< points on vertical surfaces, one in each cell of 0.25 m
  double overlap = 0;        ///< share of them with a counterpart within 1 m
  double on_plane = 0;       ///< share of these within 0.1 m of their counterpart's plane

  static constexpr std::size_t kLeastPoints = 50;
  /// Whether there are kLeastPoints, half of them overlap, and 60 % of these lie on planes.
  /// Scans of one place, up to 20 m apart, have an overlap of 0.86 and on_plane of 0.75 or more
  /// (KITTI 0009, simulated streets; 16 to 64 rings); of two places up to 0.45, or on_plane up to
  /// 0.53. An error of 1 m along a street of plain walls does not show.
  bool shows_one_place() const;
};

/// Checks a registration, from the scan that fits the other one better: a scan of a wider view has
/// parts that the other one lacks.
/// @param target, source  as those of register_scans(), z up
FOVEA_API ScanFit scan_fit(const PointCloud& target, const PointCloud& source,
                           const RigidMotion& T_target_source);

}  // namespace fovea
