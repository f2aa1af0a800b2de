// A map's points in Python.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <tuple>
#include <utility>

#include "fovea/map/color_display.h"
#include "fovea/map/tile_map.h"
#include "fovea/point_cloud.h"

namespace fovea::python {

/// Which points of a cloud: every `step`-th from `begin` on, as a slice of Python.
struct PointRows {
  std::ptrdiff_t begin = 0, step = 1;
  std::size_t count = 0;

  std::size_t operator[](std::size_t i) const {
    return static_cast<std::size_t>(begin + static_cast<std::ptrdiff_t>(i) * step);
  }
};

/// Points of a cloud, which slices and arrays over its columns share.
struct Points {
  Points(PointCloud points, std::shared_ptr<const ColorDisplay> color_display)
      : cloud(std::make_shared<const PointCloud>(std::move(points))),
        display(std::move(color_display)),
        rows{0, 1, cloud->size()} {}
  std::shared_ptr<const PointCloud> cloud;
  std::shared_ptr<const ColorDisplay> display;  ///< of the colors
  PointRows rows;
};

/// A TileId as a tuple: submap, x, y, z.
using TileTuple = std::tuple<std::size_t, std::int32_t, std::int32_t, std::int32_t>;

inline TileTuple tuple_of(const TileId& id) { return {id.submap, id.key.x, id.key.y, id.key.z}; }
inline TileId id_of(const TileTuple& tuple) {
  const auto [submap, x, y, z] = tuple;
  return {submap, {x, y, z}};
}

}  // namespace fovea::python
