// Which kind of drive a folder holds.
#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

#include "fovea/core/path_remedy.h"
#include "fovea/drive/calibrated_drive.h"
#include "fovea/drive/drive_files.h"
#include "fovea/drive/frame_source.h"
#include "fovea/drive/generic_drive.h"
#include "fovea/drive/kitti/kitti_drives.h"
#include "fovea/errors.h"

namespace fovea {

namespace {

namespace fs = std::filesystem;

/// "a, b, c, ..." of the first few names, relative to the root.
std::string list_drives(const std::vector<fs::path>& drives, const fs::path& root) {
  constexpr std::size_t kShown = 5;
  std::string text;
  for (std::size_t i = 0; i < std::min(drives.size(), kShown); ++i) {
    text += (i > 0 ? ", " : "") + drives[i].lexically_relative(root).string();
  }
  return text + (drives.size() > kShown ? ", ..." : "");
}

/// Names a data set that has scans but no drive, for an error. Empty for any other folder.
std::string_view data_set_without_drives(const fs::path& folder) {
  for (const char* part : {"", "training", "testing"}) {
    const fs::path root = folder / part;
    const bool has_parts = fs::is_directory(root / "calib") || fs::is_directory(root / "label_2");
    if (has_parts && fs::is_directory(root / "velodyne") && !fs::exists(root / "calib.txt")) {
      return "KITTI's object data set, whose scans are of different places";
    }
  }
  for (const char* part : {"samples", "sweeps"}) {
    if (fs::is_directory(folder / part / "LIDAR_TOP")) return "the nuScenes data set";
  }
  return {};
}

std::unique_ptr<FrameSource> open_recognised(const fs::path& path, const DriveOptions& options) {
  constexpr const char* kRemedy =
      "give a folder with a drive.toml (docs/drives.md), a KITTI raw drive "
      "(.../DATE/DATE_drive_NNNN_sync) or an odometry sequence (.../sequences/NN)";
  if (!fs::exists(path)) throw InputError("the drive does not exist", path.string(), kRemedy);
  if (!fs::is_directory(path)) throw InputError("the drive is no folder", path.string(), kRemedy);
  if (is_calibrated_drive_file(path / "drive.toml")) return open_calibrated_drive(path, options);
  if (fs::exists(path / "drive.toml")) return open_generic_drive(path, options);
  if (const std::string_view data_set = data_set_without_drives(path); !data_set.empty()) {
    throw InputError("the folder is of " + std::string(data_set), path.string(), kRemedy);
  }
  if (fs::is_directory(path / "velodyne_points")) return open_kitti_raw(path, options);
  if (fs::is_directory(path / "velodyne")) return open_kitti_odometry(path, options);
  if (fs::is_empty(path)) throw InputError("the drive's folder is empty", path.string(), kRemedy);
  const std::vector<fs::path> drives = raw_drives_below(path);
  if (drives.size() == 1) return open_kitti_raw(drives.front(), options);
  if (drives.size() > 1) {
    throw InputError("the folder holds " + std::to_string(drives.size()) +
                         " drives: " + list_drives(drives, path),
                     path.string(), "name one of them");
  }
  throw InputError("the folder has neither drive.toml nor velodyne_points/ or velodyne/ (KITTI)",
                   path.string(), kRemedy);
}

}  // namespace

std::unique_ptr<FrameSource> open_drive(const fs::path& path, const DriveOptions& options) {
  try {
    auto drive = open_recognised(path, options);
    require_cameras_of_masks(options, drive->info());
    return drive;
  } catch (const fs::filesystem_error& error) {  // no permission, a broken disk
    throw InputError("the drive cannot be read (" + error.code().message() + ")",
                     error.path1().string(),
                     path_remedy(error.code().value(), "check its permissions and its disk"));
  }
}

}  // namespace fovea
