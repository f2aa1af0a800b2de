// What is known of one point's colour.
#pragma once

#include <cstddef>
#include <cstdint>

#include "fovea/core/point_cloud.h"

namespace fovea {

/// One colour from many views (mapping/color_fusion.h).
struct FusedColor {
  LogColor color;            ///< meaningful where a camera gave one
  std::uint8_t views = 0;    ///< images that gave the colour; 255: or more
  std::uint8_t spread = 0;   ///< RMS of their differences from it, grey values
  std::uint16_t weight = 0;  ///< sum of their weights

  friend bool operator==(const FusedColor&, const FusedColor&) = default;
};

/// Of a point of a cloud that has the columns.
inline FusedColor color_of(const PointCloud& points, std::size_t i) {
  return {points.color[i], points.views[i], points.spread[i], points.weight[i]};
}

}  // namespace fovea
