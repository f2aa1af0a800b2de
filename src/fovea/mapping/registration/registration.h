// Scan registration: one optimiser over interchangeable factors (paper: Pose Refinement).
#pragma once

#include <Eigen/Core>
#include <span>
#include <string>
#include <vector>

#include "fovea/geometry/point_index.h"
#include "fovea/geometry/rigid_motion.h"
#include "fovea/mapping/registration/optimizer.h"

namespace fovea {

enum class RegistrationMethod { kGicp, kPointToPoint, kPointToPlane };

struct RegistrationOptions {
  RegistrationMethod method = RegistrationMethod::kGicp;
  int max_iterations = 100;             ///< point to point takes dozens, the others a few
  int max_points = 0;                   ///< of a cloud, at even steps, that are kept; 0: all
  double max_distance = 1.0;            ///< m, pairs further apart are not used
  double converged_rotation = 1e-4;     ///< rad: a smaller step ends the iteration
  double converged_translation = 1e-3;  ///< m
  int neighbors = 10;                   ///< k of the local covariance (normals, GICP)
  double plane_epsilon = 1e-3;          ///< GICP: variance along the normal over that in the plane
  /// Robust kernel (Geman-McClure) width in m; 0 switches it off.
  double robust_width = 0.0;
  /// A direction of motion is degenerate if the planes of the target say less than this of it, per
  /// pair: the mean square of the change of distance to the plane per metre moved, or per tenth of
  /// a radian turned about the sensor. A street gives its least known direction 0.1 and more, a
  /// featureless corridor 0.0025 (errors of the normals alone). Without normals (point to point)
  /// every direction looks known.
  double degenerate_eigenvalue = 0.01;
  void validate() const;  ///< ConfigError that names the field
};

/// A cloud ready to be registered.
///
/// The methods with planes need the normals of the target. GICP also needs those of the source.
struct RegistrationCloud {
  std::vector<Eigen::Vector3f> points;   ///< m
  std::vector<Eigen::Vector3f> normals;  ///< unit, zero where unknown; empty where not needed
};

/// At most max_points of the finite points, taken at even steps.
/// @param points  m
RegistrationCloud select_points(std::vector<Eigen::Vector3f> points, int max_points);

/// The points that select_points() takes. Unless the method is point to point, with their normals,
/// which are fitted to all points (normals.h).
/// @param points   m, in the sensor's frame
/// @param spacing  that the points have been thinned to (m); 0: they are not thinned
RegistrationCloud prepare_cloud(std::vector<Eigen::Vector3f> points,
                                const RegistrationOptions& options, double spacing = 0);

struct RegistrationResult {
  RigidMotion T_target_source = RigidMotion::Identity();
  bool converged = false;
  int iterations = 0;
  std::size_t pairs = 0;          ///< in the last iteration
  double rms_distance = 0;        ///< m, over the last iteration's pairs
  int degenerate_directions = 0;  ///< of six; the step was not taken along them
  /// What the pairs say of the pose, as if none had anything to do with another (which it has): of
  /// a twist of the source about its own origin, 1/rad^2, 1/m^2.
  Eigen::Matrix<double, 6, 6> information = Eigen::Matrix<double, 6, 6>::Zero();
};

/// Aligns source to target from a first guess: pairs of nearest points, a few damped Gauss-Newton
/// steps on them, new pairs, until the pose settles. The same result at any number of threads.
///
/// Floats are precise enough within some 100 m of the target's origin. Never throws on data: fewer
/// than 50 pairs are no evidence (not converged, T_target_source = guess, six degenerate
/// directions). Point to point takes small steps: from a poor guess give it 100 iterations.
/// @param target       with normals unless point to point; the index is of its points
/// @param source       in the sensor's frame, the sensor at the origin; with normals for GICP
/// @param prior        of the pose, such as navigation's
RegistrationResult register_clouds(const RegistrationCloud& target, const PointIndex& target_index,
                                   const RegistrationCloud& source, const RigidMotion& guess,
                                   const RegistrationOptions& options,
                                   const std::optional<PosePrior>& prior = std::nullopt);

}  // namespace fovea
