// Where the vehicle is at any time.
#pragma once

#include <array>

#include "fovea/rigid_motion.h"
#include "fovea/simulation/carried_motion.h"
#include "fovea/simulation/path.h"
#include "fovea/simulation/simulation_options.h"

namespace fovea {

/// Motion of the vehicle along a path: speed that changes, weaving in the lane, roll, pitch and
/// heave; all smooth (sums of sines whose phases come from the seed). On wheels it always points
/// where it goes; other carriers add CarriedMotion. With speed_variation, weave, sway and heave at
/// 0 on a path of constant curvature its twist is constant.
class VehicleMotion {
 public:
  /// Keeps a reference to the path, which must reach as far as longest_way() says.
  /// @param lane_offset  m to the left of the path (right-hand traffic: negative)
  VehicleMotion(const Path& path, double lane_offset, const VehicleOptions& options, int seed);

  /// World: x, y as the path's, z up, the road at 0. Vehicle: forward, left, up, on the road below
  /// the LiDAR. `time` in seconds from frame 0's stamp.
  RigidMotion T_world_vehicle(double time) const;
  /// Way along the path (m), 0 at time 0; never decreases.
  double way(double time) const;

 private:
  const Path* path_;
  double lane_offset_;
  VehicleOptions options_;
  CarriedMotion carried_;
  std::array<double, 10> phases_;  // rad: speed, weave, roll, pitch, heave, two each
};

/// How far a path must reach before and beyond s = 0 for a drive that goes on for so many seconds
/// before or after time 0 (m).
double longest_way(const VehicleOptions& options, double seconds);

}  // namespace fovea
