// SweepTiming of a drive whose points have no times: keys, stamps and defaults.
#pragma once

#include <optional>
#include <string>

#include "fovea/drive/drive_description.h"
#include "fovea/geometry/sensor_profile.h"

namespace fovea {

/// Fills the values that drive.toml does not state.
/// @param stamp_step  s, median step of the stamps; absent if it cannot be the period of a sweep
SweepTiming sweep_timing(const SweepDescription& described, std::optional<double> stamp_step);

/// One line with every value of the timing and its source.
/// @param timing  result of sweep_timing() for the same arguments
std::string assumed_sweep_note(const SweepTiming& timing, const LidarDescription& lidar,
                               std::optional<double> stamp_step);

}  // namespace fovea
