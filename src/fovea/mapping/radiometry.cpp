#include "fovea/mapping/radiometry.h"

#include <algorithm>
#include <cmath>

#include "fovea/core/parallel.h"

namespace fovea {
namespace {

constexpr std::size_t kMinPoints = 150;
constexpr float kWindow = 12;         // codes, 3.2 %
constexpr float kBiweightReach = 96;  // codes, 26 %: values farther from the mode do not count
constexpr int kRounds = 6;

/// The middle of the window that holds most of some sorted values.
float fullest_window(const std::vector<float>& sorted) {
  std::size_t best_begin = 0, best_end = 0;
  for (std::size_t begin = 0, end = 0; begin < sorted.size(); ++begin) {
    while (end < sorted.size() && sorted[end] <= sorted[begin] + kWindow) ++end;
    if (end - begin > best_end - best_begin) best_begin = begin, best_end = end;
  }
  return sorted[best_begin + (best_end - best_begin) / 2];
}

}  // namespace

void CodeDifferences::append(const CodeDifferences& other) {
  for (std::size_t c = 0; c < 3; ++c) {
    channel[c].insert(channel[c].end(), other.channel[c].begin(), other.channel[c].end());
  }
}

float mode_of(std::vector<float> values) {
  std::sort(values.begin(), values.end());
  double mode = double(fullest_window(values));
  for (int round = 0; round < kRounds; ++round) {
    double sum = 0, weights = 0;
    for (const float value : values) {
      const double u = (double(value) - mode) / double(kBiweightReach);
      if (std::abs(u) >= 1) continue;
      const double weight = (1 - u * u) * (1 - u * u);
      weights += weight;
      sum += weight * double(value);
    }
    mode = sum / weights;
  }
  return static_cast<float>(mode);
}

LogGain ViewGains::next(int camera, const CodeDifferences& image_minus_map) {
  LogGain& last = last_.try_emplace(camera, LogGain::Zero()).first->second;
  if (const auto gain = gain_of(image_minus_map)) last = *gain;
  return last;
}

double residual_percent(const CodeDifferences& image_minus_map, const LogGain& gain) {
  double sum = 0;
  for (std::size_t c = 0; c < 3; ++c) {
    const float code = gain[Eigen::Index(c)] * float(kColorCodesPerStop);
    for (const float value : image_minus_map.channel[c]) sum += double(std::abs(value - code));
  }
  const double codes = sum / (3 * double(std::max<std::size_t>(1, image_minus_map.size())));
  return 100 * (std::exp2(codes / kColorCodesPerStop) - 1);
}

std::optional<LogGain> gain_of(const CodeDifferences& image_minus_map) {
  if (image_minus_map.size() < kMinPoints) return std::nullopt;
  LogGain gain;
  parallel_for(3, 1, [&](std::size_t c) {
    gain[Eigen::Index(c)] = mode_of(image_minus_map.channel[c]) / float(kColorCodesPerStop);
  });
  return gain;
}

}  // namespace fovea
