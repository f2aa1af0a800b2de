#include "fovea/geometry/imu_gap.h"

#include <algorithm>

#include "fovea/core/median.h"

namespace fovea {

TimeNs imu_gap_limit(const std::vector<ImuSample>& samples, int usual_steps) {
  constexpr TimeNs kShortest = kNsPerSecond / 40;
  std::vector<TimeNs> steps;
  for (std::size_t i = 1; i < samples.size(); ++i) {
    steps.push_back(samples[i].time - samples[i - 1].time);
  }
  return std::max(kShortest, usual_steps * median_of(std::move(steps)));
}

}  // namespace fovea
