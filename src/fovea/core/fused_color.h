// What the map keeps of the color of a point.
#pragma once

#include <cstddef>
#include <cstdint>

#include "fovea/point_cloud.h"

namespace fovea {

/// One color from many views (mapping/color_fusion.h).
struct FusedColor {
  LogColor color;              ///< meaningful where a camera gave one
  std::uint8_t views = 0;      ///< images that gave the color; 255: or more
  std::uint8_t spread = 0;     ///< RMS of the views' log differences from it, kSpreadStep codes
  std::uint16_t weight = 0;    ///< sum of the weights of the views
  std::uint8_t saturated = 0;  ///< bits 0, 1, 2: red, green, blue is saturated in every view

  friend bool operator==(const FusedColor&, const FusedColor&) = default;
};

/// Color codes of one step of FusedColor::spread, 1.1 %.
inline constexpr int kSpreadStep = 4;

/// Of a point of a cloud that has the columns.
inline FusedColor color_of(const PointCloud& points, std::size_t i) {
  return {points.color[i], points.views[i], points.spread[i], points.weight[i],
          points.saturated.empty() ? std::uint8_t{0} : points.saturated[i]};
}

}  // namespace fovea
