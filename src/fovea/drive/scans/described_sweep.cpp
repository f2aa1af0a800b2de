#include "fovea/drive/scans/described_sweep.h"

#include <fmt/format.h>

#include "fovea/core/angle.h"

namespace fovea {

SweepTiming sweep_timing(const SweepDescription& described, std::optional<double> stamp_step) {
  SweepTiming timing;
  timing.period = described.period.value_or(stamp_step.value_or(timing.period));
  timing.direction = described.direction.value_or(timing.direction);
  timing.start_azimuth = described.start_azimuth.value_or(timing.start_azimuth);
  timing.stamp_phase = described.stamp_phase.value_or(timing.stamp_phase);
  return timing;
}

std::string assumed_sweep_note(const SweepTiming& timing, const LidarDescription& lidar,
                               std::optional<double> stamp_step) {
  const SweepDescription& described = lidar.sweep;
  const auto source = [](bool stated) { return stated ? "drive.toml" : "default"; };
  const bool clockwise = timing.direction == SweepDirection::kClockwise;
  return fmt::format(
      "the points have no times; assumed: a sweep takes {:.4g} s ({}), turns {} ({}), starts at "
      "{:.4g} degrees ({}), has its stamp at {:.3g} of the sweep ({}); to change: [{}] "
      "sweep_period_s, rotation, sweep_start_deg, stamp_phase in drive.toml",
      timing.period,
      !described.period && stamp_step ? "step of the stamps" : source(described.period.has_value()),
      clockwise ? "clockwise" : "counterclockwise", source(described.direction.has_value()),
      timing.start_azimuth / kDegree, source(described.start_azimuth.has_value()),
      timing.stamp_phase, source(described.stamp_phase.has_value()), lidar.table());
}

}  // namespace fovea
