// KITTI's calibration: of a raw drive (three files, "---" between them) and of an odometry
// sequence.
#include <fstream>

#include "fovea/drive/kitti/kitti_calibration.h"
#include "fuzz_input.h"
#include "scratch_folder.h"

using namespace fovea;

namespace {

constexpr std::array kFiles{"calib_cam_to_cam.txt", "calib_velo_to_cam.txt",
                            "calib_imu_to_velo.txt"};

void check(const KittiCalibration& calibration) {
  require(calibration.T_cam0_lidar.matrix().allFinite(), "the LiDAR's pose is finite");
  require(!calibration.T_imu_lidar || calibration.T_imu_lidar->matrix().allFinite(),
          "the unit's pose is finite");
  for (const auto& [index, camera] : calibration.cameras) {
    require(camera.index == index, "cameras stand under their number");
    require(camera.fx > 0 && camera.fy > 0, "cameras have a focal length");
    require(camera.T_cam_lidar.matrix().allFinite(), "cameras' poses are finite");
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static FileInMemory odometry;
  static const ScratchFolder folder;
  std::string_view text = as_text(data, size);
  read_or_refuse([&] { check(read_kitti_odometry_calibration(odometry.hold(text))); });
  for (const char* name : kFiles) {
    constexpr std::string_view kBetween = "---\n";
    const std::size_t end = text.find(kBetween);
    std::ofstream(folder / name, std::ios::binary) << text.substr(0, end);
    text.remove_prefix(end == text.npos ? text.size() : end + kBetween.size());
  }
  read_or_refuse([&] { check(read_kitti_raw_calibration(folder.path())); });
  return 0;
}
