#include "fovea/mapping/color_fusion.h"

#include <algorithm>
#include <cmath>

namespace fovea {
namespace {

constexpr double kWeightAtOneMetre = 100;

/// Rounds up with the probability of the fraction.
std::uint8_t round_by_chance(float value, std::uint64_t noise) {
  const float chance = static_cast<float>(noise & 0xffff) * 0x1p-16f;
  return static_cast<std::uint8_t>(std::clamp(std::floor(value + chance), 0.0f, 255.0f));
}

}  // namespace

std::uint16_t view_weight(double distance) {
  return static_cast<std::uint16_t>(std::clamp(kWeightAtOneMetre / distance, 1.0, 100.0) + 0.5);
}

FusedColor fuse(const FusedColor& before, const Eigen::Vector3f& seen, std::uint16_t weight,
                std::uint64_t noise) {
  FusedColor fused;
  fused.views = static_cast<std::uint8_t>(std::min(before.views + 1, 255));
  fused.weight = static_cast<std::uint16_t>(std::min(before.weight + weight, 65535));
  if (before.views == 0) {
    fused.color = to_rgb(seen);
    return fused;
  }
  const float gain = static_cast<float>(weight) / static_cast<float>(fused.weight);
  const Eigen::Vector3f mean = to_float(before.color), difference = seen - mean;
  const Eigen::Vector3f color = mean + gain * difference;
  fused.color = {round_by_chance(color.x(), noise), round_by_chance(color.y(), noise >> 16),
                 round_by_chance(color.z(), noise >> 32)};
  const auto spread = static_cast<float>(before.spread);
  const float variance = (1 - gain) * (spread * spread + gain * difference.squaredNorm() / 3);
  fused.spread = round_by_chance(std::sqrt(variance), noise >> 48);
  return fused;
}

}  // namespace fovea
