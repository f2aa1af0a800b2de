#include "fovea/exporting/frame_formats.h"

#include <algorithm>
#include <vector>

#include "fovea/exporting/frame_table.h"
#include "fovea/exporting/pose_writer.h"
#include "fovea/exporting/trajectory_writer.h"
#include "fovea/map/map_meta.h"

namespace fovea {

bool is_frame_format(std::string_view format) {
  return std::find(kFrameFormats.begin(), kFrameFormats.end(), format) != kFrameFormats.end();
}

void write_frame_format(const MapReader& map, std::string_view format,
                        const std::filesystem::path& path, bool force) {
  map.check();
  const std::vector<FrameRecord> frames = map.frames();
  if (format == "tum") return write_tum_trajectory(frames, path, force);
  if (format == "csv") return write_trajectory_table(frames, map_origin(map.meta()), path, force);
  if (format == "geojson") {
    return write_geojson_trajectory(frames, map_origin(map.meta()), path, force);
  }
  if (format == "frames") return write_frame_table(frames, path, force);
  write_kitti_poses(frames, path, force);
}

}  // namespace fovea
