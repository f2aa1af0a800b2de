// One colour from many views (goes past the paper, which keeps one view; docs/method.md 6).
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>

#include "fovea/base/color_block.h"
#include "fovea/base/fused_color.h"

namespace fovea {

/// Weight of a view from this many metres: one over the distance, since a near view shows more
/// detail; as an integer of 1-100, so that sums are exact.
inline std::uint16_t view_weight(float distance) {
  constexpr float kWeightAtOneMetre = 100;
  return static_cast<std::uint16_t>(std::clamp(kWeightAtOneMetre / distance, 1.0f, 100.0f) + 0.5f);
}

/// What is known of the colours of some points, a row for each part of a FusedColor; eight bits a
/// channel are all that is kept.
struct FusedColors {
  template <class T>
  using Row = std::array<T, ColorBlock::kSize>;
  Row<std::uint8_t> red, green, blue;
  Row<std::uint8_t> views;  ///< 0: the rest means nothing
  Row<std::uint8_t> spread;
  Row<std::uint16_t> weight;

  /// @param colors  of the first points
  void take(std::span<const FusedColor> colors);
  void give(std::span<FusedColor> colors) const;
};

/// One view of some points.
struct SeenColors {
  ColorBlock color;
  std::array<std::uint16_t, ColorBlock::kSize> weight;
  /// Random bits, as two words a point. Rounding up or down by chance lets steps below one grey
  /// value count, which rounding to the nearest would lose.
  std::array<std::array<std::uint32_t, ColorBlock::kSize>, 2> noise;
};

/// Takes in one more view of the first `count` points: weighted running mean and deviation (West
/// 1979). The first view of a point is its colour, rounded to the nearest.
void fuse(FusedColors& points, const SeenColors& seen, std::size_t count);

/// What two accounts of one point's colour say together, as if all their views had been fused
/// (Chan, Golub and LeVeque 1979).
FusedColor fused(const FusedColor& a, const FusedColor& b);

}  // namespace fovea
