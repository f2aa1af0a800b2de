// Range images of the simplest kind, for tests.
#pragma once

#include <cmath>
#include <numbers>

#include "fovea/core/angle.h"
#include "fovea/map/map_records.h"

namespace fovea {

/// All round, 20 degrees up and down, with one range (m) everywhere.
inline KeyframeRecord keyframe_of_range(int frame, double range) {
  KeyframeRecord image;
  image.frame = frame;
  for (double elevation = 20; elevation >= -20; elevation -= 0.5) {
    image.elevations.push_back(elevation * kDegree);
  }
  image.columns = 1440;
  image.first_azimuth = -std::numbers::pi;
  image.azimuth_step = 2 * std::numbers::pi / 1440;
  image.ranges.assign(image.elevations.size() * image.columns,
                      std::uint16_t(std::lround(100 * range)));
  return image;
}

}  // namespace fovea
