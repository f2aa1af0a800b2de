// Writes frames of any drive as a folder with a drive.toml, for tests that play it as a robot.
//
//   write_generic_drive DRIVE OUTPUT FRAMES
#include <fmt/format.h>

#include <cstdlib>
#include <exception>
#include <string>

#include "fovea/deskew.h"
#include "fovea/drive/frame_source.h"
#include "fovea/drive/writers/drive_writer.h"

namespace fovea {
namespace {

std::vector<RecordedCamera> cameras_of(const DriveInfo& drive) {
  std::vector<RecordedCamera> cameras;
  for (const Camera& camera : drive.calibration.cameras) {
    cameras.push_back(
        {fmt::format("camera_{}", camera.index),
         int(cameras.size()),
         {camera.width, camera.height, camera.fx, camera.fy, camera.cx, camera.cy, Lens()},
         camera.T_cam_lidar.inverse()});
  }
  return cameras;
}

void write(const std::string& drive_folder, const std::string& output, int frames) {
  DriveOptions options;
  options.end = frames;
  const auto drive = open_drive(drive_folder, options);
  const DriveInfo& info = drive->info();
  DriveWriterOptions writing;
  writing.sweep_compensated = info.sweep_compensated;
  AdapterWriter writer(output, cameras_of(info), writing);
  for (const int index : info.frame_indices()) {
    LoadedFrame loaded = drive->load(index);
    auto* const frame = std::get_if<Frame>(&loaded);
    if (frame == nullptr) continue;
    // Messages of scans state no sweep: the points have times.
    const bool has_times = info.sweep_compensated || !frame->scan.time.empty();
    if (!has_times) add_point_times(frame->scan, info.sweep);
    std::vector<DriveImage> images;
    for (std::size_t k = 0; k < frame->images.size(); ++k) {
      const TimeNs delay = from_seconds(camera_of(info, *frame, k).image_delay);
      images.push_back({fmt::format("camera_{}", info.calibration.cameras[k].index),
                        frame->stamp + delay, frame->images[k]});
    }
    writer.add({frame->stamp, frame->scan}, images, info.navigation->at(frame->stamp));
  }
  writer.close();
}

}  // namespace
}  // namespace fovea

int main(int argc, char** argv) {
  if (argc != 4) return 2;
  try {
    fovea::write(argv[1], argv[2], std::atoi(argv[3]));
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
  return 0;
}
