#include "fovea/map/map_store.h"
#include "fovea/map/meta_keys.h"

namespace fovea {

std::vector<RigidMotion> copy_all_but_tiles(const MapReader& map, MapWriter& output) {
  for (const auto& [key, value] : map.meta()) {
    if (key != meta_key::kFormatVersion) output.put_meta(key, value);
  }
  const std::vector<DriveRecord> drives = map.drives();
  for (std::size_t id = 0; id < drives.size(); ++id) output.put_drive(id, drives[id]);
  const std::vector<SensorRecord> sensors = map.sensors();
  for (std::size_t id = 0; id < sensors.size(); ++id) output.put_sensor(id, sensors[id]);
  for (const FrameRecord& frame : map.frames()) output.put_frame(frame);
  map.for_each_keyframe([&](const KeyframeRecord& keyframe) { output.put_keyframe(keyframe); });
  std::vector<RigidMotion> T_local_submap;
  for (const SubmapRecord& submap : map.submap_records()) {
    output.put_submap(T_local_submap.size(), submap);
    T_local_submap.push_back(submap.T_local_submap);
  }
  return T_local_submap;
}

}  // namespace fovea
