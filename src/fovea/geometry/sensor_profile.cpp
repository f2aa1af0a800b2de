#include "fovea/geometry/sensor_profile.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace fovea {

double ring_spacing_at(const SensorProfile& profile, double elevation) {
  const std::vector<double>& rings = profile.ring_elevations;
  if (rings.size() < 2) return profile.ring_spacing;
  // The first ring below the elevation, and the ring above it.
  const auto below = std::upper_bound(rings.begin(), rings.end(), elevation, std::greater<>());
  const auto lower =
      std::clamp<std::ptrdiff_t>(below - rings.begin(), 1, std::ptrdiff_t(rings.size()) - 1);
  return rings[std::size_t(lower - 1)] - rings[std::size_t(lower)];
}

double elevation_on_ground(const SensorProfile& profile, double range) {
  return -std::atan2(profile.height.value_or(kUsualSensorHeight), range);
}

double ring_gap_on_ground(const SensorProfile& profile, double range) {
  const double height = profile.height.value_or(kUsualSensorHeight);
  const double elevation = elevation_on_ground(profile, range);
  // The derivative of height / tan(elevation).
  return ring_spacing_at(profile, elevation) * (height + range * range / height);
}

}  // namespace fovea
