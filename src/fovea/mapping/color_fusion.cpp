#include "fovea/mapping/color_fusion.h"

#include <algorithm>
#include <cmath>

namespace fovea {
namespace {

/// A number between 0 and 1 from byte `k` of some random bits.
float chance(std::uint32_t random, int k) { return (float(random >> 8 * k & 0xff) + 0.5f) / 256; }

/// Rounds up if the fraction and the chance exceed 1 together.
template <class Number>
Number rounded(float value, float chance, float largest) {
  return static_cast<Number>(std::clamp(value + chance, 0.0f, largest));
}

}  // namespace

void fuse(const ColorSample& seen, std::uint32_t random, FusedColor& point) {
  const bool is_first = point.views == 0;
  if (is_first) point = FusedColor{{}, 0, 0, 0, seen.saturated};
  const int weight = std::min(point.weight + seen.weight, 65535);
  const float share = float(seen.weight) / float(weight);
  float square = 0;  // of the difference, sum over channels
  for (int c = 0; c < 3; ++c) {
    std::uint16_t& code = point.color.code[std::size_t(c)];
    const float mean = is_first ? seen.code[c] : code;
    const float difference = seen.code[c] - mean;
    code = rounded<std::uint16_t>(mean + share * difference, is_first ? 0.5f : chance(random, c),
                                  kMaxColorCode);
    square += difference * difference;
  }
  const float spread = float(point.spread * kSpreadStep);
  const float variance = (1 - share) * (spread * spread + share * square / 3);
  point.spread = rounded<std::uint8_t>(std::sqrt(variance) / kSpreadStep, chance(random, 3), 255);
  point.views = static_cast<std::uint8_t>(std::min(point.views + 1, 255));
  point.weight = static_cast<std::uint16_t>(weight);
  point.saturated &= seen.saturated;
}

FusedColor fused(const FusedColor& a, const FusedColor& b) {
  if (a.views == 0 || b.views == 0) return a.views == 0 ? b : a;
  const float share_b = float(b.weight) / std::max(float(a.weight + b.weight), 1.0f);
  FusedColor both;
  float square = 0;
  for (std::size_t c = 0; c < 3; ++c) {
    const auto of_a = float(a.color.code[c]), difference = float(b.color.code[c]) - of_a;
    both.color.code[c] = rounded<std::uint16_t>(of_a + share_b * difference, 0.5f, kMaxColorCode);
    square += difference * difference;
  }
  const auto spread_a = float(a.spread * kSpreadStep), spread_b = float(b.spread * kSpreadStep);
  const float variance = (1 - share_b) * spread_a * spread_a + share_b * spread_b * spread_b +
                         share_b * (1 - share_b) * square / 3;
  both.spread = rounded<std::uint8_t>(std::sqrt(variance) / kSpreadStep, 0.5f, 255);
  both.views = static_cast<std::uint8_t>(std::min(a.views + b.views, 255));
  both.weight = static_cast<std::uint16_t>(std::min(a.weight + b.weight, 65535));
  both.saturated = a.saturated & b.saturated;
  return both;
}

}  // namespace fovea
