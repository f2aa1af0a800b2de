// Known errors of navigation, taken out of it.
#pragma once

#include <string>
#include <vector>

#include "fovea/geometry/geodesy.h"
#include "fovea/geometry/rigid_motion.h"

namespace fovea {

/// The way from one place to another.
struct NavigationStep {
  RigidMotion T_local_first, T_local_last;  ///< of the LiDAR, by navigation
  RigidMotion T_first_last;                 ///< by the scans

  RigidMotion by_navigation() const { return T_local_first.inverse() * T_local_last; }
};
using NavigationSteps = std::vector<NavigationStep>;

/// Navigation as it is without an error.
struct NavigationRepair {
  std::string error;
  NavigationSteps steps;
};

/// Latitude, longitude or the attitudes that come with them are in other units, of another order or
/// of another convention.
std::vector<NavigationRepair> repaired_positions(const NavigationSteps& steps,
                                                 const GeodeticPoint& origin,
                                                 const RigidMotion& T_body_lidar);

/// Poses were given as T_body_world. They are known up to the origin of their world, which is
/// estimated.
NavigationRepair repaired_inversion(const NavigationSteps& steps, const RigidMotion& T_body_lidar);

/// T_body_lidar was given as T_lidar_body.
NavigationRepair repaired_place(const NavigationSteps& steps, const RigidMotion& T_body_lidar);

/// Lengths are in another unit, which is estimated.
NavigationRepair repaired_scale(const NavigationSteps& steps);

/// The LiDAR is turned on the body, by an estimated rotation.
NavigationRepair repaired_turn(const NavigationSteps& steps);

}  // namespace fovea
