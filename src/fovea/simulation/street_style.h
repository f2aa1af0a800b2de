// What a street looks like and where it runs.
#pragma once

#include "fovea/rigid_motion.h"
#include "fovea/simulation/path.h"
#include "fovea/simulation/simulation_options.h"

namespace fovea {

/// Cross section and furniture of a street. Distances are from its axis, m.
struct StreetStyle {
  double kerb = 5.7;     ///< where the pavement begins
  double front = 8.7;    ///< where the houses begin
  double far = 60;       ///< ground is laid to this distance
  bool backdrop = true;  ///< a house far behind, so that no gap looks out to the horizon
  bool raised = true;    ///< pavement above the road, with kerbs; else one level (a square)
  int min_floors = 2, max_floors = 4;
  double gap_chance = 0.25;  ///< of a garden instead of a second house
  double parked = 0.6;       ///< share of the parking places taken
  double trees = 0.55;       ///< share of tree pits with a tree
  double furniture = 0.5;    ///< chance of bench, bin, tables, ... at each place
  double bushes = 0;         ///< per metre of pavement
  double railings = 0;       ///< share of the kerb with a railing
  double bystanders = 0;     ///< per metre of pavement, standing
};
StreetStyle style_of(Scene scene);

/// A path put somewhere in the world.
struct StreetAxis {
  const Path* path = nullptr;
  double begin = 0;  ///< of this street on the path (m)
  RigidMotion T_world_path = RigidMotion::Identity();

  Eigen::Vector3d place(double s, double d, double z) const;
  /// Frame at a place: x along the street, y to the left, z up.
  RigidMotion frame(double s, double d, double z, double turn = 0) const;
};

}  // namespace fovea
