// How a rig moves that a person carries or that flies, besides the way that it follows.
#pragma once

#include "fovea/rigid_motion.h"
#include "fovea/simulation/simulation_options.h"

namespace fovea {

/// Smooth functions of the time and of the way. The amplitudes are those of a walking person or of
/// a small drone.
class CarriedMotion {
 public:
  /// @param seed  of the phases of all sines
  CarriedMotion(const VehicleOptions& options, int seed);

  /// Where the rig is in the frame of a vehicle on wheels on the same way: forward, left, up. The
  /// identity for such a vehicle itself.
  /// @param time  s
  /// @param way   m
  RigidMotion T_vehicle_carried(double time, double way) const;

 private:
  /// Angle to which the carrier has turned the rig, rad.
  double turned(double time) const;
  /// Height on the stairs, m.
  double climbed(double way) const;

  VehicleOptions options_;
  double phase_ = 0;  // rad
};

}  // namespace fovea
