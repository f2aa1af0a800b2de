#include "fovea/exporting/pose_writer.h"

#include <fmt/format.h>

#include "fovea/core/output_file.h"
#include "fovea/errors.h"
#include "fovea/geometry/pose_file.h"

namespace fovea {
namespace {

/// Interpolated lines for the indices between two frames that the drive has not.
void write_gap(const FrameRecord& before, const FrameRecord& after, std::ostream& out) {
  const double steps = after.index - before.index;
  for (int index = before.index + 1; index < after.index; ++index) {
    out << format_pose(interpolate(before.T_local_lidar, after.T_local_lidar,
                                   (index - before.index) / steps))
        << '\n';
  }
}

}  // namespace

void write_kitti_poses(const std::vector<FrameRecord>& frames, const std::filesystem::path& path,
                       bool force) {
  if (frames.empty()) {
    throw InputError("the map has no frames", path.string(), "map the drive again");
  }
  OutputFile file(path, force);
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const FrameRecord& frame = frames[i];
    if (i > 0) write_gap(frames[i - 1], frame, file.stream());
    file.stream() << format_pose(frame.T_local_lidar) << '\n';
  }
  file.commit();
}

}  // namespace fovea
