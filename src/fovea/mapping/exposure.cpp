#include "fovea/mapping/exposure.h"

#include <algorithm>
#include <cmath>

#include "fovea/core/parallel.h"

namespace fovea {
namespace {

/// Gray values: darker ones are noise, brighter ones are saturated.
constexpr float kDark = 12, kBright = 240;
constexpr std::size_t kMinPoints = 150;
constexpr float kMaxLogGain = 0.34f;
/// Share of a gain, in logarithms, that matching_gain() applies.
constexpr float kMatchedShare = 0.9f;

bool is_well_exposed(const Eigen::Array3f& color) {
  return color.minCoeff() > kDark && color.maxCoeff() < kBright;
}

}  // namespace

std::optional<Eigen::Array3f> gain_between(const Eigen::Array3f& known,
                                           const Eigen::Array3f& seen) {
  if (!is_well_exposed(known) || !is_well_exposed(seen)) return std::nullopt;
  return known / seen;
}

bool is_exposure_off(const Eigen::Array3f& gain_to_map) {
  return std::abs(gain_to_map.log().mean()) > kMaxLogGain;
}

Eigen::Array3f matching_gain(const Eigen::Array3f& gain_to_map) {
  return gain_to_map.pow(kMatchedShare);
}

Eigen::Array3f median_gain(const std::vector<Eigen::Array3f>& gains) {
  Eigen::Array3f median = Eigen::Array3f::Ones();
  if (gains.size() < kMinPoints) return median;
  parallel_for(3, 1, [&](std::size_t channel) {
    std::vector<float> values;
    values.reserve(gains.size());
    for (const Eigen::Array3f& gain : gains) values.push_back(gain[Eigen::Index(channel)]);
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    median[Eigen::Index(channel)] = *middle;
  });
  return median;
}

}  // namespace fovea
