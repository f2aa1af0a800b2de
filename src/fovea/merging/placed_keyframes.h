// Where the range images of a map were taken.
#pragma once

#include <cstddef>
#include <functional>

#include "fovea/map/map_store.h"
#include "fovea/merging/map_content.h"

namespace fovea {

/// A range image and where it was taken.
struct PlacedKeyframe {
  const KeyframeRecord& image;
  std::size_t submap = 0;
  RigidMotion T_submap_sensor = RigidMotion::Identity();
  SensorProfile profile;
};

/// Calls f for the range images of frames that belong to a submap, in the order of the map.
void for_each_placed_keyframe(const MapReader& map, const MapContent& content,
                              const std::function<void(const PlacedKeyframe&)>& f);

}  // namespace fovea
