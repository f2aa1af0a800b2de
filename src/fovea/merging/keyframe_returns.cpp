#include "fovea/merging/keyframe_returns.h"

#include <cmath>
#include <map>

namespace fovea {

std::vector<Eigen::Vector3f> returns_of(const KeyframeRecord& keyframe, double max_range) {
  std::vector<Eigen::Vector2f> azimuths;  // cosine and sine
  for (std::size_t column = 0; column < keyframe.columns; ++column) {
    const double azimuth = keyframe.first_azimuth + double(column) * keyframe.azimuth_step;
    azimuths.emplace_back(std::cos(azimuth), std::sin(azimuth));
  }
  std::vector<Eigen::Vector3f> points;
  for (std::size_t row = 0; row < keyframe.elevations.size(); ++row) {
    const auto up = float(std::sin(keyframe.elevations[row])),
               along = float(std::cos(keyframe.elevations[row]));
    for (std::size_t column = 0; column < keyframe.columns; ++column) {
      const float range = 0.01f * float(keyframe.ranges[row * keyframe.columns + column]);
      if (range == 0 || range > float(max_range)) continue;
      points.emplace_back(range * along * azimuths[column].x(),
                          range * along * azimuths[column].y(), range * up);
    }
  }
  return points;
}

void for_each_placed_keyframe(const MapReader& map, const MapContent& content,
                              const std::function<void(const PlacedKeyframe&)>& f) {
  std::map<int, const FrameRecord*> frames;
  for (const FrameRecord& frame : content.frames) frames[frame.index] = &frame;
  map.for_each_keyframe([&](const KeyframeRecord& image) {
    const auto found = frames.find(image.frame);
    if (found == frames.end() || found->second->submap < 0) return;
    const auto submap = static_cast<std::size_t>(found->second->submap);
    const auto number = static_cast<std::size_t>(image.sensor);
    const SensorRecord sensor =
        number < content.sensors.size() ? content.sensors[number] : SensorRecord{};
    f({image, submap,
       content.T_local_submap[submap].inverse() * found->second->T_local_lidar *
           sensor.T_lidar_sensor,
       sensor.profile});
  });
}

}  // namespace fovea
