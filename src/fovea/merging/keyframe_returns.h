// The range images that a map keeps.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "fovea/merging/map_content.h"

namespace fovea {

/// The returns up to a range (m), in the frame of the sensor.
std::vector<Eigen::Vector3f> returns_of(const KeyframeRecord& keyframe, double max_range = 1000);

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
