#include "fovea/map/map_point_filter.h"

#include <utility>

namespace fovea {

MapPointFilter::MapPointFilter(const MapReader& map, PointFilter filter)
    : filter_(std::move(filter)) {
  if (!filter_.needs_place()) return;
  const std::shared_ptr<const void> state = map.hold_state();
  T_local_submap_ = map.submaps();
  if (filter_.needs_height()) road_.emplace(map);
}

bool MapPointFilter::matches(std::size_t submap, const PointCloud& tile, std::size_t index) const {
  PointPlace place;
  if (filter_.needs_place()) {
    place.p_local =
        T_local_submap_.at(submap) * (tile.origin + tile.position[index].cast<double>());
    if (road_) place.height = road_->above(place.p_local);
  }
  return filter_.matches(tile, index, place);
}

}  // namespace fovea
