// Initial LiDAR velocity from the first two scans, used without navigation.
#pragma once

#include <optional>
#include <vector>

#include "fovea/drive/frame_source.h"
#include "fovea/rigid_motion.h"

namespace fovea {

/// The LiDAR's velocity at the first usable frame from `begin` on: from given poses (known_motion),
/// or else from registration of the next scan to the first. The registration repeats until motion
/// compensation by its result gives the same result. Without an initial velocity the first scan
/// stays distorted, and above about 20 m/s the second scan is out of the range of registration from
/// rest.
///
/// Empty with navigation, without a second usable frame within 1 s, or if the two scans do not fit.
/// Reads two frames.
/// @param compensate  whether raw sweeps are motion compensated
std::optional<Twist> initial_velocity(const FrameSource& source,
                                      const std::vector<RigidMotion>& given_poses, int begin,
                                      bool compensate);

}  // namespace fovea
