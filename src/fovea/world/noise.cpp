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

float cell_random(int x, int y, int z, std::uint32_t seed) {
  // Murmur3's finaliser over a linear mix of the coordinates.
  std::uint32_t h = seed * 0x9e3779b9u + static_cast<std::uint32_t>(x) * 0x85ebca6bu +
                    static_cast<std::uint32_t>(y) * 0xc2b2ae35u +
                    static_cast<std::uint32_t>(z) * 0x27d4eb2fu;
  h ^= h >> 16;
  h *= 0x85ebca6bu;
  h ^= h >> 13;
  h *= 0xc2b2ae35u;
  h ^= h >> 16;
  return static_cast<float>(h >> 8) * 0x1.0p-24f;
}

float value_noise(const Eigen::Vector3f& p, std::uint32_t seed) {
  const Eigen::Vector3f whole = p.array().floor();
  const Eigen::Vector3i c = whole.cast<int>();
  const float u = smooth(p.x() - whole.x()), v = smooth(p.y() - whole.y()),
              w = smooth(p.z() - whole.z());
  float corners[2][2][2];
  for (int k = 0; k < 2; ++k) {
    for (int j = 0; j < 2; ++j) {
      for (int i = 0; i < 2; ++i) {
        corners[k][j][i] = cell_random(c.x() + i, c.y() + j, c.z() + k, seed);
      }
    }
  }
  const auto row = [&](int k, int j) { return std::lerp(corners[k][j][0], corners[k][j][1], u); };
  const auto plane = [&](int k) { return std::lerp(row(k, 0), row(k, 1), v); };
  return 2 * std::lerp(plane(0), plane(1), w) - 1;
}

float resolved(float size, float footprint) {
  return std::clamp(1.5f - footprint / std::max(size, kSharpest), 0.0f, 1.0f);
}

float layered_noise(const Eigen::Vector3f& p, float longest, float shortest, float footprint,
                    std::uint32_t seed) {
  float sum = 0, amplitude = 0.6f;
  for (float length = longest; length >= 0.75f * shortest; length *= 0.5f, amplitude *= 0.6f) {
    const float weight = resolved(0.5f * length, footprint);  // two samples a wave
    if (weight <= 0) break;                                    // so are all that follow
    sum += weight * amplitude * value_noise(p / length, seed);
    seed += 0x51ed27u;
  }
  return sum;
}

float band(float x, float low, float high, float footprint) {
  const float f = std::max(footprint, kSharpest);
  const float from = std::max(x - 0.5f * f, low), to = std::min(x + 0.5f * f, high);
  return std::max(to - from, 0.0f) / f;
}

float repeated_band(float x, float period, float width, float footprint) {
  const float f = std::max(footprint, kSharpest);
  return (repeated_length(x + 0.5f * f, period, width) -
          repeated_length(x - 0.5f * f, period, width)) /
         f;
}

}  // namespace fovea
