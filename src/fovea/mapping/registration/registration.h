// Scan registration: one optimiser over interchangeable factors (paper: Pose Refinement).
#pragma once

#include <Eigen/Core>
#include <span>
#include <string>
#include <vector>

#include "fovea/geometry/kd_tree.h"
#include "fovea/geometry/rigid_motion.h"

namespace fovea {

enum class RegistrationMethod { kGicp, kPointToPoint, kPointToPlane };

struct RegistrationOptions {
  RegistrationMethod method = RegistrationMethod::kGicp;
  int max_iterations = 30;
  double max_distance = 1.0;            ///< m, pairs further apart are not used
  double converged_rotation = 1e-4;     ///< rad: a smaller step ends the iteration
  double converged_translation = 1e-3;  ///< m
  int neighbors = 10;                   ///< k of the local covariance (normals, GICP)
  double plane_epsilon = 1e-3;          ///< GICP: variance along the normal over that in the plane
  /// Robust kernel (Geman-McClure) width in m; 0 switches it off.
  double robust_width = 0.0;
  /// A direction whose normal-equation eigenvalue per pair is below this is degenerate.
  double degenerate_eigenvalue = 0.01;
  void validate() const;  ///< ConfigError that names the field
};

/// A cloud ready to be registered: points with what the method needs beside them.
struct RegistrationCloud {
  std::vector<Eigen::Vector3f> points;   ///< m
  std::vector<Eigen::Vector3f> normals;  ///< unit; empty for point to point
};

/// Normals from the k nearest neighbours of each point (plane of least variance).
RegistrationCloud prepare_cloud(std::vector<Eigen::Vector3f> points,
                                const RegistrationOptions& options);

struct RegistrationResult {
  RigidMotion T_target_source = RigidMotion::Identity();
  bool converged = false;
  int iterations = 0;
  std::size_t pairs = 0;          ///< in the last iteration
  double rms_distance = 0;        ///< m, over the last iteration's pairs
  int degenerate_directions = 0;  ///< of six; the step was not taken along them
};

/// Aligns source to target from a first guess; never throws on data (too few pairs: not converged,
/// T_target_source = guess).
RegistrationResult register_clouds(const RegistrationCloud& target, const KdTree& target_tree,
                                   const RegistrationCloud& source, const RigidMotion& guess,
                                   const RegistrationOptions& options);

}  // namespace fovea
