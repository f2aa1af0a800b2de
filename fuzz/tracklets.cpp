// KITTI's tracklets.
#include "fovea/drive/kitti/tracklets.h"

#include "fuzz_input.h"

using namespace fovea;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static FileInMemory file;
  read_or_refuse([&] {
    for (const Tracklet& tracklet : read_tracklets(file.hold(as_text(data, size)))) {
      require(tracklet.size.allFinite() && tracklet.size.minCoeff() > 0, "boxes have a size");
      require(tracklet.first_frame >= 0, "frames count from 0");
      for (const RigidMotion& T_lidar_box : tracklet.T_lidar_box) {
        require(T_lidar_box.matrix().allFinite(), "poses are finite");
      }
      tracklet.contains(tracklet.first_frame, {1, 2, 3}, 0.1);
    }
  });
  return 0;
}
