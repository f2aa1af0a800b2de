#include "fovea/exporting/pose_writer.h"

#include <fmt/format.h>

#include "fovea/base/errors.h"
#include "fovea/base/output_file.h"
#include "fovea/geometry/pose_file.h"

namespace fovea {

void write_kitti_poses(const std::vector<FrameRecord>& frames, const std::filesystem::path& path,
                       bool force) {
  constexpr const char* kRemedy = "map the drive again";
  if (frames.empty()) throw InputError("the map has no frames", path.string(), kRemedy);
  OutputFile file(path, force);
  int expected = frames.front().index;
  for (const FrameRecord& frame : frames) {
    if (frame.index != expected) {
      throw InputError("a frame of the map is missing", fmt::format("frame {}", expected), kRemedy);
    }
    file.stream() << format_pose(frame.T_local_lidar) << '\n';
    ++expected;
  }
  file.commit();
}

}  // namespace fovea
