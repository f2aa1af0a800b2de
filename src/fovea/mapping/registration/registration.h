// Scan registration: one loop and one optimizer for several factors (paper: Pose Refinement).
#pragma once

#include <Eigen/Core>
#include <span>
#include <string>
#include <vector>

#include "fovea/geometry/point_index.h"
#include "fovea/geometry/rigid_motion.h"
#include "fovea/mapping/registration/optimizer.h"
#include "fovea/mapping/registration/registration_policies.h"

namespace fovea {

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

/// A cloud ready to be registered.
///
/// The methods with planes need the normals of the target. GICP also needs those of the source.
struct RegistrationCloud {
  std::vector<Eigen::Vector3f> points;   ///< m
  std::vector<Eigen::Vector3f> normals;  ///< unit, zero where unknown; empty where not needed
};

/// At most max_points of the finite points, at even steps.
/// @param points  m
RegistrationCloud select_points(std::vector<Eigen::Vector3f> points, int max_points);

/// The points of select_points(), with normals unless the method is point to point. Normals are
/// fitted to all points (normals.h).
/// @param points   m, in the sensor's frame
/// @param spacing  least distance between thinned points (m); 0: the points are not thinned
RegistrationCloud prepare_cloud(std::vector<Eigen::Vector3f> points,
                                const RegistrationOptions& options, double spacing = 0);

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

/// Aligns source to target from a first guess by iterative closest point. The result is the same
/// at any number of threads.
///
/// Floats are precise enough within some 100 m of the target's origin. Data cause no exception:
/// with fewer than 50 pairs the result is not converged, T_target_source is the guess, and all six
/// directions are degenerate. Point to point takes small steps and may need 100 iterations.
/// @param target  with normals unless point to point; target_index is over its points
/// @param source  in the sensor's frame, the sensor at the origin; with normals for GICP
/// @param prior   of the pose, for example from navigation
RegistrationResult register_clouds(const RegistrationCloud& target, const PointIndex& target_index,
                                   const RegistrationCloud& source, const RigidMotion& guess,
                                   const RegistrationOptions& options,
                                   const std::optional<PosePrior>& prior = std::nullopt);

}  // namespace fovea
