#include "fovea/drive/recordings/missing_messages.h"

#include <algorithm>
#include <cmath>

#include "fovea/core/median.h"

namespace fovea {
namespace {

constexpr std::size_t kLeastStamps = 10;  // fewer do not show a rate
/// Share of the intervals that a steady rate has within kJitter of the median one.
constexpr double kSteady = 0.7, kJitter = 0.2;

}  // namespace

std::size_t missing_messages(const std::vector<TimeNs>& stamps) {
  if (stamps.size() < kLeastStamps) return 0;
  std::vector<double> intervals;
  for (std::size_t i = 1; i < stamps.size(); ++i) {
    intervals.push_back(double(stamps[i] - stamps[i - 1]));
  }
  const double period = median_of(intervals);
  const auto steady = std::count_if(intervals.begin(), intervals.end(), [&](double interval) {
    return std::abs(interval - period) < kJitter * period;
  });
  if (double(steady) < kSteady * double(intervals.size())) return 0;
  std::size_t missing = 0;
  for (const double interval : intervals) {
    missing += std::size_t(std::max(0.0, std::round(interval / period) - 1));
  }
  return missing;
}

}  // namespace fovea
