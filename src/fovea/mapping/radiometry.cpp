#include "fovea/mapping/radiometry.h"

#include <algorithm>
#include <cmath>

#include "fovea/core/parallel.h"

namespace fovea {
namespace {

constexpr std::size_t kMinPoints = 150;
constexpr float kWindow = 12;  // codes, 3.2 %
constexpr int kRounds = 6;

/// Counts of values in bins of equal width.
class Histogram {
 public:
  Histogram(const std::vector<float>& values, float width)
      : width_(width), low_(*std::min_element(values.begin(), values.end())) {
    const float high = *std::max_element(values.begin(), values.end());
    counts_.resize(bin_of(high) + 1);
    for (const float value : values) ++counts_[bin_of(value)];
  }

  /// The middle of the window of some bins that holds most values.
  float fullest_window(std::size_t bins) const {
    std::size_t inside = 0, most = 0, best = 0;
    for (std::size_t end = 0; end < counts_.size(); ++end) {
      inside += counts_[end];
      if (end >= bins) inside -= counts_[end - bins];
      if (inside > most) most = inside, best = end;
    }
    return center_of(best) - width_ * float(bins - 1) / 2;
  }

  /// Median of the distances from a value.
  float median_distance(float from) const {
    std::vector<std::size_t> at_distance(counts_.size() + 1);
    std::size_t all = 0;
    for (std::size_t bin = 0; bin < counts_.size(); ++bin) {
      const auto steps = static_cast<std::size_t>(std::abs(center_of(bin) - from) / width_ + 0.5f);
      at_distance[std::min(steps, counts_.size())] += counts_[bin];
      all += counts_[bin];
    }
    std::size_t steps = 0, within = at_distance[0];
    while (within <= all / 2) within += at_distance[++steps];
    return float(steps) * width_;
  }

  /// Mean of the values under Tukey's biweight.
  float weighted_mean(const Mode& mode) const {
    double sum = 0, weights = 0;
    for (std::size_t bin = 0; bin < counts_.size(); ++bin) {
      const auto value = static_cast<double>(center_of(bin));
      const double weight = double(counts_[bin]) * biweight(value, mode);
      weights += weight;
      sum += weight * value;
    }
    return static_cast<float>(sum / weights);
  }

 private:
  std::size_t bin_of(float value) const {
    return static_cast<std::size_t>((value - low_) / width_ + 0.5f);
  }
  float center_of(std::size_t bin) const { return low_ + float(bin) * width_; }
  float width_, low_;
  std::vector<std::size_t> counts_;
};

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

Mode mode_of(const std::vector<float>& values, float window) {
  constexpr std::size_t kBins = 16;  // of a window
  constexpr float kDeviations = 3;
  const Histogram histogram(values, window / kBins);
  Mode mode{histogram.fullest_window(kBins), 0};
  for (int round = 0; round < kRounds; ++round) {
    mode.reach =
        std::clamp(kDeviations * histogram.median_distance(mode.value), window, 8 * window);
    mode.value = histogram.weighted_mean(mode);
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
  parallel_for(3, 1, [&](std::size_t c) {
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
    if (chosen.size() < kMinPoints) return;
    of_channel = mode_of(chosen, kWindow).value / float(kColorCodesPerStop);
  });
  return gain;
}

}  // namespace fovea
