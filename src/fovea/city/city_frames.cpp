#include "fovea/city/city_frames.h"

#include <algorithm>
#include <utility>

namespace fovea {

const std::string& CityFrames::map_id() const {
  return drive.source_digest ? *drive.source_digest : drive.name;
}

std::vector<CityFrames> frames_of_tile(const City& city, const CityTile& tile,
                                       const MapReader& map) {
  const auto held = map.hold_state();
  const RigidMotion T_city_tile = city.T_local_tile(tile);
  std::vector<CityFrames> drives;
  for (DriveRecord& drive : map.drives()) drives.push_back({std::move(drive), {}});
  for (FrameRecord& frame : map.frames()) {
    const auto of = std::find_if(drives.begin(), drives.end(), [&](const CityFrames& drive) {
      return drive.drive.has_frame(frame.index);
    });
    if (of == drives.end()) continue;
    frame.index -= of->drive.frame_shift;
    frame.T_local_lidar = T_city_tile * frame.T_local_lidar;
    frame.submap = -1;
    of->frames.push_back(std::move(frame));
  }
  return drives;
}

}  // namespace fovea
