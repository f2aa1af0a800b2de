#include "fovea/mapping/exposure.h"

#include <algorithm>
#include <cmath>

#include "fovea/base/parallel.h"

namespace fovea {
namespace {

/// Grey values that tell: darker ones are noise, brighter ones saturated.
constexpr float kDark = 12, kBright = 240;
constexpr std::size_t kMinPoints = 150;
constexpr float kOffGain = 0.34f;  // its logarithm

bool tells_exposure(const Eigen::Array3f& color) {
  return color.minCoeff() > kDark && color.maxCoeff() < kBright;
}

}  // namespace

std::optional<Eigen::Array3f> gain_between(const Eigen::Array3f& known,
                                           const Eigen::Array3f& seen) {
  if (!tells_exposure(known) || !tells_exposure(seen)) return std::nullopt;
  return known / seen;
}

bool is_exposure_off(const Eigen::Array3f& gain_to_map) {
  return std::abs(gain_to_map.log().mean()) > kOffGain;
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
