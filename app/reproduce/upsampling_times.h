// The paper's Table I: how long upsampling takes.
#pragma once

#include <cstddef>
#include <vector>

#include "fovea/sensor/frame_source.h"

namespace fovea::app {

struct UpsamplingTime {
  int wanted = 0;          ///< points to be produced, the paper's column
  std::size_t given = 0;   ///< measured points that were upsampled
  std::size_t points = 0;  ///< all points after upsampling
  int rate = 0;
  double seconds = 0;  ///< median of some runs, on one thread
};

/// Upsamples the drive's middle scan in its first camera's view to about as many points as each
/// column of the paper's table: the lowest rate that gives as many, of as many points of the scan
/// (drawn with a fixed seed) as it takes. Fewer where the scan does not give as many at the highest
/// rate.
std::vector<UpsamplingTime> time_upsampling(const FrameSource& drive);

}  // namespace fovea::app
