#include "fovea/mapping/color_fusion.h"

#include <cmath>

namespace fovea {
namespace {

/// A number of [0, 1) from the lower 16 bits.
float chance_of(std::uint32_t bits) {
  return static_cast<float>(static_cast<std::int32_t>(bits & 0xffff)) * 0x1p-16f;
}

/// Rounds up with the probability of the fraction.
std::uint8_t rounded(float value, float chance) {
  const float clamped = std::min(std::max(value + chance, 0.0f), 255.0f);
  return static_cast<std::uint8_t>(static_cast<std::int32_t>(clamped));
}

}  // namespace

void fuse(FusedColors& points, const SeenColors& seen, std::size_t count) {
  using Row = std::array<float, ColorBlock::kSize>;
  Row gain, square;
  for (std::size_t i = 0; i < count; ++i) {
    const int before = points.views[i] == 0 ? 0 : points.weight[i];
    const int total = std::min(before + seen.weight[i], 65535);
    points.weight[i] = static_cast<std::uint16_t>(total);
    gain[i] = static_cast<float>(seen.weight[i]) / static_cast<float>(total);
    square[i] = 0;
  }
  const auto fuse_channel = [&](FusedColors::Row<std::uint8_t>& channel, const Row& color,
                                const auto& noise, int shift) {
    for (std::size_t i = 0; i < count; ++i) {
      const auto mean = static_cast<float>(channel[i]);
      const float difference = color[i] - mean, chance = chance_of(noise[i] >> shift);
      channel[i] = rounded(mean + gain[i] * difference, points.views[i] == 0 ? 0.5f : chance);
      square[i] += difference * difference;
    }
  };
  fuse_channel(points.red, seen.color.red, seen.noise[0], 0);
  fuse_channel(points.green, seen.color.green, seen.noise[0], 16);
  fuse_channel(points.blue, seen.color.blue, seen.noise[1], 0);
  for (std::size_t i = 0; i < count; ++i) {
    const auto spread = static_cast<float>(points.spread[i]);
    const float mean_square = square[i] * (1.0f / 3);
    const float variance = (1 - gain[i]) * (spread * spread + gain[i] * mean_square);
    points.spread[i] = rounded(std::sqrt(variance), chance_of(seen.noise[1][i] >> 16));
    points.views[i] = static_cast<std::uint8_t>(std::min(points.views[i] + 1, 255));
  }
}

}  // namespace fovea
