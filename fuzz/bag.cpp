// Recordings of ROS 2, MCAP and SQLite, plain or compressed as a whole: what a pass over them
// finds, and what is made of it.
#include "fovea/drive/recordings/bag.h"

#include <fstream>

#include "fovea/drive/recordings/bag_index.h"
#include "fovea/drive/recordings/camera_topics.h"
#include "fovea/drive/recordings/navigation_topics.h"
#include "fuzz_input.h"
#include "scratch_folder.h"

using namespace fovea;

namespace {

void check(const SensorTopic& topic) {
  require(!topic.stamps.empty(), "a sensor has messages");
  for (std::size_t i = 1; i < topic.stamps.size(); ++i) {
    require(topic.stamps[i - 1] < topic.stamps[i], "stamps ascend");
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const ScratchFolder folder;
  const std::filesystem::path file = folder / "a.bag";
  std::ofstream(file, std::ios::binary) << as_text(data, size);
  BagIndex index;
  if (!read_or_refuse([&] { index = index_bags({file}, folder.path()); })) {
    return 0;
  }
  std::string lidar_frame = "lidar";
  for (const auto& [name, cloud] : index.lidars) check(cloud), lidar_frame = cloud.frame;
  for (const auto& [name, images] : index.images) check(images);
  std::vector<std::string> notes;
  read_or_refuse([&] {
    const auto cameras = plan_cameras(index, {}, lidar_frame, notes);
    require(cameras.size() <= 10, "cameras have numbers of one digit");
  });
  for (const NavigationSource source :
       {NavigationSource::kAuto, NavigationSource::kOdometry, NavigationSource::kTf}) {
    ConvertOptions options;
    options.poses = source;
    RecordedDrive drive;
    read_or_refuse([&] { plan_navigation(index, options, lidar_frame, drive, notes); });
  }
  return 0;
}
