// A map's points in Python.
#pragma once

#include <cstdint>
#include <memory>
#include <tuple>
#include <utility>

#include "fovea/map/color_display.h"
#include "fovea/map/tile_map.h"
#include "fovea/point_cloud.h"

namespace fovea::python {

/// Arrays over its columns share it.
struct Points {
  Points(PointCloud points, std::shared_ptr<const ColorDisplay> color_display)
      : cloud(std::make_shared<const PointCloud>(std::move(points))),
        display(std::move(color_display)) {}
  std::shared_ptr<const PointCloud> cloud;
  std::shared_ptr<const ColorDisplay> display;  ///< of the colors
};

/// A TileId as a tuple: submap, x, y, z.
using TileTuple = std::tuple<std::size_t, std::int32_t, std::int32_t, std::int32_t>;

inline TileTuple tuple_of(const TileId& id) { return {id.submap, id.key.x, id.key.y, id.key.z}; }
inline TileId id_of(const TileTuple& tuple) {
  const auto [submap, x, y, z] = tuple;
  return {submap, {x, y, z}};
}

}  // namespace fovea::python
