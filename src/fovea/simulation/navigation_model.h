// GPS/INS records as KITTI's OXTS unit would have written them.
#pragma once

#include <string>
#include <vector>

#include "fovea/geometry/geodesy.h"
#include "fovea/simulation/rig.h"
#include "fovea/simulation/simulation_options.h"
#include "fovea/simulation/vehicle_motion.h"
#include "fovea/time.h"

namespace fovea {

struct NavigationRecord {
  TimeNs time = 0;  ///< on the drive's clock, on which all stamps lie
  GeodeticPoint place;
  /// rad, from the imu (forward, left, up) to east-north-up: Rz(yaw) * Ry(pitch) * Rx(roll).
  double roll = 0, pitch = 0, yaw = 0;
  double accuracy = 0;             ///< m, of a coordinate; infinite without satellites
  Twist velocity = Twist::Zero();  ///< of the imu in its own frame, a second
  std::string text;                ///< the 30 fields of oxts/data/NNNNNNNNNN.txt, one line
};

/// What the fields mean (oxts/dataformat.txt).
std::string navigation_format_text();

/// One record a frame, of the time at which it was taken: its scan's stamp and a delay, which is
/// the same without noise: stamps do not lie. Position, angles, velocities and rates are off by
/// navigation_errors(); accelerations (of which gravity is a part, as the unit measures it) are the
/// motion's own. The motion's path must reach half a second beyond the last stamp.
/// @param T_world_local  the truth's local frame in the world (a translation): east-north-up at
///                       options.navigation.origin
std::vector<NavigationRecord> simulate_navigation(const VehicleMotion& motion, const Rig& rig,
                                                  const RigidMotion& T_world_local,
                                                  const SimulationOptions& options);

}  // namespace fovea
