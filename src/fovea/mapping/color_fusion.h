// One color from many views (docs/method.md 6). The paper keeps one view.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>

#include "fovea/core/color_block.h"
#include "fovea/core/fused_color.h"

namespace fovea {

/// Weight of a view: the inverse of its distance (m), since a near view shows more detail. An
/// integer from 1 to 100, so that sums are exact.
inline std::uint16_t view_weight(float distance) {
  constexpr float kWeightAtOneMeter = 100;
  return static_cast<std::uint16_t>(std::clamp(kWeightAtOneMeter / distance, 1.0f, 100.0f) + 0.5f);
}

/// Colors of a block of points: one array for each member of FusedColor.
struct FusedColors {
  template <class T>
  using Row = std::array<T, ColorBlock::kSize>;
  Row<std::uint8_t> red, green, blue;
  Row<std::uint8_t> views;  ///< 0: the other values are meaningless
  Row<std::uint8_t> spread;
  Row<std::uint16_t> weight;

  /// @param colors  of the first points
  void load(std::span<const FusedColor> colors);
  void store(std::span<FusedColor> colors) const;
};

/// One view of some points.
struct ColorObservations {
  ColorBlock color;
  std::array<std::uint16_t, ColorBlock::kSize> weight;
  /// Two random words for each point. Random rounding keeps changes below one gray value, which
  /// rounding to the nearest would lose.
  std::array<std::array<std::uint32_t, ColorBlock::kSize>, 2> noise;
};

/// Adds one view to the first `count` points: weighted running mean and deviation (West 1979). A
/// point without views gets the color of the view, rounded to the nearest.
void fuse(FusedColors& points, const ColorObservations& seen, std::size_t count);

/// The color of one point from two disjoint sets of views (Chan, Golub and LeVeque 1979).
FusedColor fused(const FusedColor& a, const FusedColor& b);

}  // namespace fovea
