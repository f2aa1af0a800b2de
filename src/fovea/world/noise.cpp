#include "fovea/world/noise.h"

#include <algorithm>
#include <cmath>

namespace fovea {
namespace {

constexpr float kSharpest = 1e-4f;  // m: a footprint below is taken as this

float smooth(float x) { return x * x * (3 - 2 * x); }

/// Length of the bands [0, width) of period `period` up to x.
float repeated_length(float x, float period, float width) {
  const float whole = std::floor(x / period);
  return whole * width + std::min(x - whole * period, width);
}

}  // namespace

float cell_random(int x, int y, std::uint32_t seed) {
  // Murmur3's finaliser over a linear mix of the coordinates.
  std::uint32_t h = seed * 0x9e3779b9u + static_cast<std::uint32_t>(x) * 0x85ebca6bu +
                    static_cast<std::uint32_t>(y) * 0xc2b2ae35u;
  h ^= h >> 16;
  h *= 0x85ebca6bu;
  h ^= h >> 13;
  h *= 0xc2b2ae35u;
  h ^= h >> 16;
  return static_cast<float>(h >> 8) * 0x1.0p-24f;
}

float value_noise(const Eigen::Vector2f& p, std::uint32_t seed) {
  const Eigen::Vector2f whole = p.array().floor();
  const int x = static_cast<int>(whole.x()), y = static_cast<int>(whole.y());
  const float u = smooth(p.x() - whole.x()), v = smooth(p.y() - whole.y());
  const float a = cell_random(x, y, seed), b = cell_random(x + 1, y, seed);
  const float c = cell_random(x, y + 1, seed), d = cell_random(x + 1, y + 1, seed);
  const float low = a + u * (b - a), high = c + u * (d - c);
  return 2 * (low + v * (high - low)) - 1;
}

float resolved(float size, float footprint) {
  return std::clamp(1.5f - footprint / std::max(size, kSharpest), 0.0f, 1.0f);
}

float layered_noise(const Eigen::Vector2f& p, float longest, float shortest, float footprint,
                    std::uint32_t seed) {
  float sum = 0, amplitude = 0.6f, length = longest;
  while (length >= 0.75f * shortest) {
    const float weight = resolved(0.5f * length, footprint);  // two samples a wave
    if (weight <= 0) break;                                   // so are all that follow
    sum += weight * amplitude * value_noise(p / length, seed);
    seed += 0x51ed27u;
    length *= 0.5f;
    amplitude *= 0.6f;
  }
  return sum;
}

float band(float x, float low, float high, float footprint) {
  const float f = std::max(footprint, kSharpest);
  // Relative to x: a kilometre from the origin a float's steps are as wide as a footprint.
  const float from = std::max(-0.5f * f, low - x), to = std::min(0.5f * f, high - x);
  return std::clamp((to - from) / f, 0.0f, 1.0f);
}

float repeated_band(float x, float period, float width, float footprint) {
  const float f = std::max(footprint, kSharpest);
  const float into = x - period * std::floor(x / period);
  if (f <= period) {
    float share = 0;
    for (const float at : {into - period, into, into + period}) share += band(at, 0, width, f);
    return std::min(share, 1.0f);
  }
  return (repeated_length(into + 0.5f * f, period, width) -
          repeated_length(into - 0.5f * f, period, width)) /
         f;
}

}  // namespace fovea
