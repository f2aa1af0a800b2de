// Conditions on points, applied to one map: it knows where its points lie.
#pragma once

#include <optional>
#include <vector>

#include "fovea/map/map_store.h"
#include "fovea/map/point_filter.h"
#include "fovea/map/road_height.h"

namespace fovea {

/// The one way to filter the points of a map, so that all commands give the same answer.
///
///   const MapPointFilter filter(map, PointFilter::parse("height < 2 and views >= 2"));
///   map.for_each_tile([&](std::size_t submap, const TileKey&, const PointCloud& tile) {
///     for (std::size_t i = 0; i < tile.size(); ++i) {
///       if (filter.matches(submap, tile, i)) ...
class MapPointFilter {
 public:
  /// Reads the path of the vehicle if a condition needs it. InputError if the map is damaged.
  /// Submaps have the poses of now.
  MapPointFilter(const MapReader& map, PointFilter filter);

  bool empty() const { return filter_.empty(); }

  /// @param tile  of that submap, with the columns of a map's tile
  bool matches(std::size_t submap, const PointCloud& tile, std::size_t index) const;

 private:
  PointFilter filter_;
  std::vector<RigidMotion> T_local_submap_;  // only if a condition needs it
  std::optional<RoadHeight> road_;           // likewise
};

}  // namespace fovea
