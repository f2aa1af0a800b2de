// Which kind of drive a folder holds.
#include "fovea/base/errors.h"
#include "fovea/sensor/frame_source.h"
#include "fovea/sensor/kitti_drives.h"

namespace fovea {

namespace {

namespace fs = std::filesystem;

std::unique_ptr<FrameSource> open_recognised(const fs::path& path, const DriveOptions& options) {
  constexpr const char* kRemedy =
      "give a KITTI raw drive (.../DATE/DATE_drive_NNNN_sync) or odometry sequence "
      "(.../sequences/NN)";
  if (!fs::exists(path)) throw InputError("the drive does not exist", path.string(), kRemedy);
  if (!fs::is_directory(path)) throw InputError("the drive is no folder", path.string(), kRemedy);
  if (fs::is_directory(path / "velodyne_points")) return open_kitti_raw(path, options);
  if (fs::is_directory(path / "velodyne")) return open_kitti_odometry(path, options);
  if (fs::is_empty(path)) throw InputError("the drive's folder is empty", path.string(), kRemedy);
  throw InputError("the folder has neither velodyne_points/ (KITTI raw) nor velodyne/ (odometry)",
                   path.string(), kRemedy);
}

}  // namespace

std::unique_ptr<FrameSource> open_drive(const fs::path& path, const DriveOptions& options) {
  try {
    return open_recognised(path, options);
  } catch (const fs::filesystem_error& error) {  // no permission, a broken disk
    throw InputError("the drive cannot be read (" + error.code().message() + ")",
                     error.path1().string(), "check its permissions and its disk");
  }
}

}  // namespace fovea
