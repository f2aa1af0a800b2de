// A small tile of a map, with all columns.
#pragma once

#include <limits>

#include "fovea/map/tile_points.h"

namespace fovea {

inline PointCloud sample_tile() {
  PointCloud tile;
  for (int i = 0; i < 6; ++i) {
    const float x = 0.1f * static_cast<float>(i);
    tile.position.push_back({x, 1.5f * x, 0.25f});
    tile.intensity.push_back(x);
    tile.range.push_back(3 + x);
    tile.incidence.push_back(i == 0 ? std::numeric_limits<float>::quiet_NaN() : x);
    tile.color.push_back({std::uint8_t(i), 128, 255});
    tile.frame.push_back(i);
    tile.camera.push_back(i % 3 == 0 ? kNoCamera : std::int8_t{2});
    tile.interpolated.push_back(std::uint8_t(i % 2));
    tile.views.push_back(std::uint8_t(i));
    tile.spread.push_back(4);
    tile.weight.push_back(std::uint16_t(300 * i));
    tile.reason.push_back(i % 2 == 0 ? 0x10 : 2);
  }
  return TilePoints::of(tile).cloud();
}

}  // namespace fovea
