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

void FusedColors::load(std::span<const FusedColor> colors) {
  for (std::size_t i = 0; i < colors.size(); ++i) {
    const Rgb color = to_rgb(colors[i].color);
    red[i] = color.r;
    green[i] = color.g;
    blue[i] = color.b;
    views[i] = colors[i].views;
    spread[i] = colors[i].spread;
    weight[i] = colors[i].weight;
  }
}

void FusedColors::store(std::span<FusedColor> colors) const {
  for (std::size_t i = 0; i < colors.size(); ++i) {
    colors[i] = {{red[i], green[i], blue[i]}, views[i], spread[i], weight[i]};
  }
}

void fuse(FusedColors& points, const ColorObservations& seen, std::size_t count) {
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

FusedColor fused(const FusedColor& a, const FusedColor& b) {
  if (a.views == 0 || b.views == 0) return a.views == 0 ? b : a;
  const auto weight_a = static_cast<float>(a.weight), weight_b = static_cast<float>(b.weight);
  const float total = std::max(weight_a + weight_b, 1.0f), share_b = weight_b / total;
  float square = 0;
  const auto mean = [&](std::uint8_t of_a, std::uint8_t of_b) {
    const auto from = static_cast<float>(of_a), difference = static_cast<float>(of_b) - from;
    square += difference * difference;
    return rounded(from + share_b * difference, 0.5f);
  };
  FusedColor both;
  const Rgb of_a = to_rgb(a.color), of_b = to_rgb(b.color);
  both.color = {mean(of_a.r, of_b.r), mean(of_a.g, of_b.g), mean(of_a.b, of_b.b)};
  const auto spread_a = static_cast<float>(a.spread), spread_b = static_cast<float>(b.spread);
  const float variance = (1 - share_b) * spread_a * spread_a + share_b * spread_b * spread_b +
                         share_b * (1 - share_b) * square / 3;
  both.spread = rounded(std::sqrt(variance), 0.5f);
  both.views = static_cast<std::uint8_t>(std::min(int{a.views} + int{b.views}, 255));
  both.weight = static_cast<std::uint16_t>(std::min(int{a.weight} + int{b.weight}, 65535));
  return both;
}

}  // namespace fovea
