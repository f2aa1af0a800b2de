// Moving clouds from one frame of reference to another.
#pragma once

#include "fovea/point_cloud.h"
#include "fovea/rigid_motion.h"

namespace fovea {

/// The cloud (positions and normals) in frame a, relative to `origin_a`.
/// @param points_b  frame b, with any origin
PointCloud transform_cloud(PointCloud points_b, const RigidMotion& T_a_b,
                           const Eigen::Vector3d& origin_a = Eigen::Vector3d::Zero());

}  // namespace fovea
