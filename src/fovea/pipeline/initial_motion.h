// How the LiDAR moves when a drive begins that nothing tells of: by its first two scans.
#pragma once

#include <optional>
#include <vector>

#include "fovea/geometry/rigid_motion.h"
#include "fovea/sensor/frame_source.h"

namespace fovea {

/// The LiDAR's velocity at the first usable frame from `begin` on, where navigation does not say
/// it: by the poses given (see known_motion), or else by registering the next scan with the first
/// until their sweeps, undone by the motion found, give the same motion again. Without it the first
/// scan would stay bent by as far as the vehicle moves meanwhile, and above 20 m/s or so the second
/// would lie beyond registration's reach of "at rest", and so all that follow.
///
/// Nothing where navigation says it, and where no second usable frame comes within 0.3 s or
/// the two do not fit. Reads two frames.
/// @param compensate  sweeps, where the drive's scans are raw
std::optional<Twist> initial_velocity(const FrameSource& source,
                                      const std::vector<RigidMotion>& given_poses, int begin,
                                      bool compensate);

}  // namespace fovea
