// Scan registration: one loop and one optimizer for several factors (paper: Pose Refinement).
#pragma once

#include <Eigen/Core>
#include <span>
#include <string>
#include <vector>

#include "fovea/geometry/point_index.h"
#include "fovea/mapping/registration/optimizer.h"
#include "fovea/registration.h"

namespace fovea {

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
