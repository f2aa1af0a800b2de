#include "fovea/world/material.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "fovea/world/lettering.h"
#include "fovea/world/noise.h"

namespace fovea {
namespace {

using Eigen::Vector2f;
using Eigen::Vector3f;

constexpr std::array<std::string_view, 13> kPatternNames = {
    "plain",  "checker", "grain", "asphalt", "road",      "slabs", "bricks",
    "boards", "foliage", "bark",  "grass",   "lettering", "facade"};

Vector3f mix(const Vector3f& a, const Vector3f& b, float share) { return a + share * (b - a); }

Vector3f tinted(const Vector3f& color, float factor) {
  return (color * std::max(factor, 0.0f)).cwiseMin(1.0f);
}

/// Cell number along one axis, for random numbers.
int cell(float x, float size) { return static_cast<int>(std::floor(x / size)); }

Vector3f checker(const Material& m, const Vector2f& p, float f) {
  const float x = 2 * repeated_band(p.x(), 2 * m.scale, m.scale, f) - 1;
  const float y = 2 * repeated_band(p.y(), 2 * m.scale, m.scale, f) - 1;
  return mix(m.color, m.color_2, 0.5f - 0.5f * x * y);
}

Vector3f grain(const Material& m, const Vector2f& p, float f) {
  const float fine = layered_noise(p, 0.04f, 0.01f, f, m.seed);
  const float stains = layered_noise(p, 3.0f, 0.2f, f, m.seed + 1);
  return tinted(m.color, 1 + m.contrast * (0.12f * fine + 0.22f * stains));
}

Vector3f asphalt(const Material& m, const Vector2f& p, float f) {
  const float fine = layered_noise(p, 0.03f, 0.01f, f, m.seed);
  const float wear = layered_noise(p, 5.0f, 0.4f, f, m.seed + 1);
  float tone = 1 + m.contrast * (0.30f * fine + 0.20f * wear);
  // Cracks run where a slow noise passes through zero; their width is a centimetre.
  const float ridge = value_noise(p / 1.7f, m.seed + 2) + 0.4f * value_noise(p / 0.3f, m.seed + 3);
  const float where = value_noise(p / 6.0f, m.seed + 4);
  if (where > 0.15f) tone *= 1 - 0.55f * m.contrast * band(ridge * 0.5f, -0.006f, 0.006f, f);
  // Patches of another age: in some cells of 7 m a rectangle, with a sealed edge.
  constexpr float kCell = 7;
  const int cx = cell(p.x(), kCell), cy = cell(p.y(), kCell);
  if (cell_random(cx, cy, m.seed + 5) < 0.3f) {
    const float w = 0.8f + 2.0f * cell_random(cx, cy, m.seed + 6);
    const float h = 1.0f + 3.5f * cell_random(cx, cy, m.seed + 7);
    const float x = p.x() - kCell * static_cast<float>(cx) - 1.0f;
    const float y = p.y() - kCell * static_cast<float>(cy) - 1.0f;
    const float inside = band(x, 0, w, f) * band(y, 0, h, f);
    const float core = band(x, 0.04f, w - 0.04f, f) * band(y, 0.04f, h - 0.04f, f);
    tone *= 1 - 0.30f * m.contrast * inside - 0.25f * m.contrast * (inside - core);
  }
  return tinted(m.color, tone);
}

/// Share of paint on a road: s across from its middle, t along it.
float road_paint(const Material& m, float s, float t, float f) {
  constexpr float kLine = 0.06f;  // half a line's width
  const float half = m.size.x(), period = m.size.y();
  const float dash = repeated_band(t, period, period * 0.5f, f);
  float paint = band(s, -kLine, kLine, f) * dash;
  paint += band(std::abs(s), half - 0.35f, half - 0.23f, f);
  constexpr float kCrossings = 80, kCrossingAt = 37, kCrossingLong = 3.2f;  // zebra crossings
  const float along = t - kCrossings * std::floor(t / kCrossings);
  const float zebra = band(along, kCrossingAt, kCrossingAt + kCrossingLong, f);
  if (zebra > 0) {
    const float bars =
        repeated_band(s + 0.25f, 1.0f, 0.5f, f) * band(std::abs(s), -1, half - 0.4f, f);
    paint = paint * (1 - zebra) + zebra * bars;
  }
  return std::min(paint, 1.0f);
}

Vector3f road(const Material& m, const Vector2f& p, float f) {
  Vector3f color = asphalt(m, p, f);
  // Manholes, one in some cells of 17 m, off the middle.
  constexpr float kCell = 17, kRadius = 0.33f;
  const int c = cell(p.y(), kCell);
  const Vector2f from(p.x() - (cell_random(c, 0, m.seed + 9) - 0.5f) * m.size.x() * 1.4f,
                      p.y() - kCell * (static_cast<float>(c) + 0.5f));
  const float radius = from.norm();
  if (radius < kRadius + f) {
    const float lid = band(radius, -1, kRadius, f);
    const float studs =
        repeated_band(from.x(), 0.08f, 0.04f, f) * repeated_band(from.y(), 0.08f, 0.04f, f);
    const float rim = band(radius, kRadius - 0.03f, kRadius, f);
    color = mix(color, tinted(Vector3f::Constant(0.10f), 1 + 0.8f * studs - 0.6f * rim), lid);
  }
  const float paint = road_paint(m, p.x(), p.y(), f);
  if (paint <= 0) return color;
  const float worn = 0.80f + 0.35f * layered_noise(p, 0.5f, 0.02f, f, m.seed + 8);
  return mix(color, m.color_2, paint * std::clamp(worn, 0.0f, 1.0f));
}

/// Random numbers -0.5 to 0.5, one a cell of `size` along an axis, averaged over the footprint.
template <class RandomOf>
float mean_of_cells(float x, float size, float f, const RandomOf& random_of) {
  const int last = cell(x + 0.5f * f, size);
  float sum = 0;
  for (int k = cell(x - 0.5f * f, size); k <= last; ++k) {
    const auto low = static_cast<float>(k) * size;
    sum += band(x, low, low + size, f) * (random_of(k) - 0.5f);
  }
  return sum;
}

/// Cells with a tint of their own, joints between them; odd rows may be shifted by half a cell.
Vector3f cells(const Material& m, const Vector2f& p, float f, float joint, bool shifted) {
  const float width = m.size.x(), height = m.size.y();
  const auto column_place = [&](int row) {
    return p.x() + (shifted && (row & 1) != 0 ? 0.5f * width : 0.0f);
  };
  const float keep = resolved(2 * m.size.minCoeff(), f);
  float tint = 0;
  if (keep > 0) {
    tint = keep * mean_of_cells(p.y(), height, f, [&](int row) {
             return 0.5f + mean_of_cells(column_place(row), width, f, [&](int column) {
                      return cell_random(column, row, m.seed);
                    });
           });
  }
  const float fine = layered_noise(p, 0.06f, 0.01f, f, m.seed + 1);
  const float stains = layered_noise(p, 3.0f, 0.3f, f, m.seed + 2);
  const Vector3f face =
      tinted(m.color, 1 + m.contrast * (0.45f * tint + 0.15f * fine + 0.18f * stains));
  const float odd = shifted ? repeated_band(p.y() - height, 2 * height, height, f) : 0.0f;
  const float vertical = (1 - odd) * repeated_band(column_place(0), width, joint, f) +
                         odd * repeated_band(column_place(1), width, joint, f);
  const float level = repeated_band(p.y(), height, joint, f);
  return mix(face, m.color_2, vertical + level - vertical * level);
}

Vector3f boards(const Material& m, const Vector2f& p, float f) {
  const int board = cell(p.x(), m.scale);
  const float keep = resolved(2 * m.scale, f);
  const float tint = keep <= 0 ? 0.0f : keep * mean_of_cells(p.x(), m.scale, f, [&](int k) {
                                          return cell_random(k, 0, m.seed);
                                        });
  const float veins = layered_noise({p.x() * 12, p.y()}, 0.4f, 0.05f, 12 * f,
                                    m.seed + 1 + static_cast<std::uint32_t>(board));
  const Vector3f wood = tinted(m.color, 1 + m.contrast * (0.3f * tint + 0.25f * veins));
  return tinted(wood, 1 - 0.6f * repeated_band(p.x(), m.scale, 0.008f, f));
}

Vector3f foliage(const Material& m, const Vector3f& p, float f) {
  const int leaf = static_cast<int>(p.z());
  const float tone = cell_random(leaf, 0, m.seed), hue = cell_random(leaf, 1, m.seed);
  const float veins =
      layered_noise(p.head<2>(), 0.06f, 0.015f, f, m.seed + static_cast<std::uint32_t>(leaf));
  return tinted(mix(m.color, m.color_2, hue),
                1 + m.contrast * (0.7f * (tone - 0.5f) + 0.15f * veins));
}

Vector3f bark(const Material& m, const Vector2f& p, float f) {
  const float streaks = layered_noise({p.x() * 5, p.y()}, 0.3f, 0.05f, 5 * f, m.seed);
  return tinted(m.color, 1 + 0.6f * m.contrast * streaks);
}

Vector3f grass(const Material& m, const Vector2f& p, float f) {
  const float blades = layered_noise(p, 0.05f, 0.0125f, f, m.seed);
  const float patches = layered_noise(p, 4.0f, 0.4f, f, m.seed + 1);
  return tinted(mix(m.color, m.color_2, std::clamp(0.5f + 0.7f * patches, 0.0f, 1.0f)),
                1 + m.contrast * 0.5f * blades);
}

Vector3f facade(const Material& m, const Vector2f& p, float f) {
  const Vector2f window = 0.5f * m.size;
  const float glass = repeated_band(p.x() - 0.25f * m.size.x(), m.size.x(), window.x(), f) *
                      repeated_band(p.y() - 0.3f * m.size.y(), m.size.y(), window.y(), f);
  return mix(grain(m, p, f), m.color_2, glass);
}

float encode_channel(float x) {
  return x <= 0.0031308f ? 12.92f * x : 1.055f * std::pow(x, 1 / 2.4f) - 0.055f;
}
float decode_channel(float x) {
  return x <= 0.04045f ? x / 12.92f : std::pow((x + 0.055f) / 1.055f, 2.4f);
}

}  // namespace

std::string_view to_string(Pattern pattern) {
  return kPatternNames.at(static_cast<std::size_t>(pattern));
}

Pattern parse_pattern(std::string_view name) {
  const auto at = std::find(kPatternNames.begin(), kPatternNames.end(), name);
  if (at == kPatternNames.end()) {
    throw std::invalid_argument("no pattern is called " + std::string(name));
  }
  return static_cast<Pattern>(at - kPatternNames.begin());
}

Vector3f albedo(const Material& m, const Vector3f& texture, float footprint) {
  const Vector2f p = texture.head<2>();
  constexpr float kSlabJoint = 0.008f, kMortar = 0.010f;
  switch (m.pattern) {
    case Pattern::kPlain:
      return m.color;
    case Pattern::kChecker:
      return checker(m, p, footprint);
    case Pattern::kGrain:
      return grain(m, p, footprint);
    case Pattern::kAsphalt:
      return asphalt(m, p, footprint);
    case Pattern::kRoad:
      return road(m, p, footprint);
    case Pattern::kSlabs:
      return cells(m, p, footprint, kSlabJoint, false);
    case Pattern::kBricks:
      return cells(m, p, footprint, kMortar, true);
    case Pattern::kBoards:
      return boards(m, p, footprint);
    case Pattern::kFoliage:
      return foliage(m, texture, footprint);
    case Pattern::kBark:
      return bark(m, p, footprint);
    case Pattern::kGrass:
      return grass(m, p, footprint);
    case Pattern::kLettering:
      return mix(m.color, m.color_2, lettering_ink(m.text, p, m.size, footprint));
    case Pattern::kFacade:
      return facade(m, p, footprint);
  }
  throw std::invalid_argument("a material has no such pattern");
}

Vector3f encode_srgb_float(const Vector3f& linear) {
  return 255 * linear.cwiseMax(0.0f).unaryExpr(&encode_channel);
}

Rgb encode_srgb(const Vector3f& linear) { return to_rgb(encode_srgb_float(linear)); }

Vector3f decode_srgb(Rgb color) { return (to_float(color) / 255).unaryExpr(&decode_channel); }

}  // namespace fovea
