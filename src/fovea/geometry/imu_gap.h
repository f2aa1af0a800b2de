// Gaps in the samples of an IMU.
#pragma once

#include <vector>

#include "fovea/geometry/imu_data.h"

namespace fovea {

/// A longer time from sample to sample is a gap: 25 ms, or some usual steps.
TimeNs imu_gap_limit(const std::vector<ImuSample>& samples, int usual_steps = 5);

}  // namespace fovea
