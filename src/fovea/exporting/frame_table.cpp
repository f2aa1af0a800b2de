#include "fovea/exporting/frame_table.h"

#include <fmt/format.h>

#include <cmath>
#include <set>

#include "fovea/core/output_file.h"
#include "fovea/errors.h"

namespace fovea {
namespace {

std::set<int> cameras_of(const std::vector<FrameRecord>& frames) {
  std::set<int> cameras;
  for (const FrameRecord& frame : frames) {
    for (const ViewRecord& view : frame.views) cameras.insert(view.camera);
  }
  return cameras;
}

std::string header_of(const std::set<int>& cameras) {
  std::string header = "index,time_ns,status";
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 4; ++column) header += fmt::format(",T_{}{}", row, column);
  }
  for (const int camera : cameras) {
    for (const char channel : {'r', 'g', 'b'})
      header += fmt::format(",gain_{}_{}", camera, channel);
  }
  return header;
}

std::string line_of(const FrameRecord& frame, const std::set<int>& cameras) {
  std::string line = fmt::format("{},{},{}", frame.index,
                                 frame.stamp ? fmt::format("{}", *frame.stamp) : std::string(),
                                 to_string(frame.status));
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 4; ++column) {
      line += fmt::format(",{}", frame.T_local_lidar.matrix()(row, column));
    }
  }
  for (const int camera : cameras) {
    std::string gains = ",,,";
    const ViewRecord* view = frame.find_view(camera);
    if (view != nullptr && view->log2_gain) {
      const Eigen::Vector3d& log2 = *view->log2_gain;
      gains =
          fmt::format(",{},{},{}", std::exp2(log2.x()), std::exp2(log2.y()), std::exp2(log2.z()));
    }
    line += gains;
  }
  return line;
}

}  // namespace

void write_frame_table(const std::vector<FrameRecord>& frames, const std::filesystem::path& path,
                       bool force) {
  if (frames.empty()) {
    throw InputError("the map has no frames", path.string(), "map the drive again");
  }
  const std::set<int> cameras = cameras_of(frames);
  OutputFile file(path, force);
  file.stream() << header_of(cameras) << '\n';
  for (const FrameRecord& frame : frames) file.stream() << line_of(frame, cameras) << '\n';
  file.commit();
}

}  // namespace fovea
