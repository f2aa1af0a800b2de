#include "fovea/merging/placed_keyframes.h"

#include <map>

namespace fovea {

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
