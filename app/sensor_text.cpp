#include "app/sensor_text.h"

#include <fmt/format.h>

#include "fovea/core/angle.h"

namespace fovea::app {

std::string to_text(const SensorProfile& profile) {
  const auto& rings = profile.ring_elevations;
  std::string text = "no rings";
  if (!rings.empty()) {
    text = fmt::format("{} rings from {:+.1f} to {:+.1f} degrees, {:.2f} degrees apart",
                       rings.size(), rings.front() / kDegree, rings.back() / kDegree,
                       profile.ring_spacing / kDegree);
  }
  const bool clockwise = profile.sweep.direction == SweepDirection::kClockwise;
  text += fmt::format(", points {:.2f} degrees apart, {} sweeps of {:.4g} s, range noise {:.0f} mm",
                      profile.point_spacing / kDegree, clockwise ? "clockwise" : "counterclockwise",
                      profile.sweep.period, 1000 * profile.range_noise);
  if (profile.height) text += fmt::format(", {:.2f} m above the ground", *profile.height);
  return text;
}

}  // namespace fovea::app
