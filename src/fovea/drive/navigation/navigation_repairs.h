// Removes known errors from navigation.
#pragma once

#include <string>
#include <vector>

#include "fovea/geometry/geodesy.h"
#include "fovea/rigid_motion.h"

namespace fovea {

/// A motion between two frames.
struct NavigationStep {
  RigidMotion T_local_first, T_local_last;  ///< of the LiDAR, by navigation
  RigidMotion T_first_last;                 ///< by the scans

  RigidMotion by_navigation() const { return T_local_first.inverse() * T_local_last; }
};
using NavigationSteps = std::vector<NavigationStep>;

/// Navigation without a certain error.
struct NavigationRepair {
  std::string error;
  NavigationSteps steps;
};

/// Latitude, longitude or attitudes have other units, another order or another convention.
std::vector<NavigationRepair> repaired_positions(const NavigationSteps& steps,
                                                 const GeodeticPoint& origin,
                                                 const RigidMotion& T_body_lidar);

/// Poses were given as T_body_world. Estimates the unknown origin of their world.
NavigationRepair repaired_inversion(const NavigationSteps& steps, const RigidMotion& T_body_lidar);

/// T_body_lidar was given as T_lidar_body.
NavigationRepair repaired_place(const NavigationSteps& steps, const RigidMotion& T_body_lidar);

/// Lengths have another unit, which it estimates.
NavigationRepair repaired_scale(const NavigationSteps& steps);

/// The LiDAR is rotated on the body, by a rotation that it estimates.
NavigationRepair repaired_turn(const NavigationSteps& steps);

}  // namespace fovea
