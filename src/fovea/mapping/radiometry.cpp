#include "fovea/mapping/radiometry.h"

#include <algorithm>
#include <cmath>

#include "fovea/core/parallel.h"

namespace fovea {
namespace {

constexpr std::size_t kMinPoints = 150;
constexpr float kWindow = 12;  // codes, 3.2 %
constexpr int kRounds = 6;

/// The middle of the window that holds most of some sorted values.
float fullest_window(const std::vector<float>& sorted, float width) {
  std::size_t best_begin = 0, best_end = 0;
  for (std::size_t begin = 0, end = 0; begin < sorted.size(); ++begin) {
    while (end < sorted.size() && sorted[end] <= sorted[begin] + width) ++end;
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

double biweight(double value, const Mode& mode) {
  const double u = (value - double(mode.value)) / double(mode.reach);
  return std::abs(u) < 1 ? (1 - u * u) * (1 - u * u) : 0;
}

Mode mode_of(std::vector<float> values, float window) {
  constexpr float kDeviations = 3;
  std::sort(values.begin(), values.end());
  Mode mode{fullest_window(values, window), 0};
  for (int round = 0; round < kRounds; ++round) {
    std::vector<float> deviations;
    for (const float value : values) deviations.push_back(std::abs(value - mode.value));
    const auto middle = deviations.begin() + std::ptrdiff_t(deviations.size() / 2);
    std::nth_element(deviations.begin(), middle, deviations.end());
    mode.reach = std::clamp(kDeviations * *middle, window, 8 * window);
    double sum = 0, weights = 0;
    for (const float value : values) {
      const double weight = biweight(double(value), mode);
      weights += weight;
      sum += weight * double(value);
    }
    mode.value = static_cast<float>(sum / weights);
  }
  return mode;
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
    gain[Eigen::Index(c)] =
        mode_of(image_minus_map.channel[c], kWindow).value / float(kColorCodesPerStop);
  });
  return gain;
}

std::optional<LogGain> gain_of(const CodeDifferences& image_minus_map, const CodeDifferences& map,
                               double offset) {
  std::optional<LogGain> gain = gain_of(image_minus_map);
  if (!gain) return gain;
  const float margin = kExposureMargin * float(kColorCodesPerStop);
  const float least = exposure_code(kDarkValue, offset) + margin;
  const float most = exposure_code(kSaturatedValue, offset) - margin;
  for (std::size_t c = 0; c < 3; ++c) {
    float& of_channel = (*gain)[Eigen::Index(c)];
    std::vector<float> chosen;
    for (std::size_t i = 0; i < image_minus_map.size(); ++i) {
      const float difference = image_minus_map.channel[c][i];
      // In the exposure of the image.
      const float in_map = map.channel[c][i] + of_channel * float(kColorCodesPerStop);
      const float in_image = map.channel[c][i] + difference;
      const float mean = (in_map + in_image) / 2;
      if (mean > least && mean < most) chosen.push_back(difference);
    }
    if (chosen.size() < kMinPoints) continue;
    of_channel = mode_of(std::move(chosen), kWindow).value / float(kColorCodesPerStop);
  }
  return gain;
}

}  // namespace fovea
