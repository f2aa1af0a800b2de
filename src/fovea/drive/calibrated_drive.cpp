#include "fovea/drive/calibrated_drive.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <ranges>
#include <set>
#include <system_error>
#include <utility>

#include "fovea/core/output_file.h"
#include "fovea/drive/kitti/kitti_drives.h"
#include "fovea/drive/recalibrated_source.h"
#include "fovea/errors.h"

namespace fovea {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMaxLevels = 8;  // of calibrated drives, one above the other
constexpr const char* kFileName = "drive.toml";

/// One calibrated drive.
struct Level {
  fs::path file;   ///< its drive.toml
  fs::path drive;  ///< folder of the drive that it corrects, absolute
  DriveCorrection correction;
};

/// Empty if the file is none of a calibrated drive, or cannot be read.
std::optional<SettingsDocument> calibrated_document(const fs::path& file) {
  try {
    SettingsDocument document = SettingsDocument::from_file(file);
    if (is_calibrated_drive(document)) return document;
  } catch (const Error&) {
    return std::nullopt;  // The reader of other drives reports it.
  }
  return std::nullopt;
}

std::string place_of(const fs::path& file, std::string_view key) {
  return fmt::format("{}, key 'calibrated.{}'", file.string(), key);
}

/// The folder of the drive that a drive.toml names.
/// @param stated  relative to the folder of the file, or absolute
fs::path named_folder(const fs::path& file, const fs::path& stated) {
  const fs::path named = file.parent_path() / stated;
  std::error_code error;
  const fs::path folder = fs::canonical(named, error);
  if (!error && fs::is_directory(folder, error)) return folder;
  throw InputError(fmt::format("there is no folder {}, whose drive is corrected", named.string()),
                   place_of(file, "drive"),
                   "state where the drive is, relative to this file or absolute");
}

/// A calibrated drive, the calibrated drive that it corrects, and so on. Empty for any other drive.
std::vector<Level> levels_of(const fs::path& drive) {
  std::vector<Level> levels;
  std::error_code ignored;
  std::set<fs::path> seen{fs::canonical(drive, ignored)};
  fs::path file = drive / kFileName;
  while (const auto document = calibrated_document(file)) {
    if (levels.size() == kMaxLevels) {
      throw InputError(fmt::format("over {} drives correct one another", kMaxLevels), file.string(),
                       "name the recorded drive in calibrated.drive");
    }
    CalibratedDrive calibrated = parse_calibrated_drive(*document);
    const fs::path folder = named_folder(file, calibrated.drive);
    if (!seen.insert(folder).second) {
      throw InputError("the drives correct each other in a circle", place_of(file, "drive"),
                       "name the recorded drive");
    }
    levels.push_back({file, folder, std::move(calibrated.correction)});
    file = folder / kFileName;
  }
  return levels;
}

/// A folder above the only raw drive below it also stands for that drive.
std::optional<fs::path> only_drive_below(const fs::path& folder) {
  try {
    const auto has = [&](const char* name) { return fs::exists(folder / name); };
    if (has(kFileName) || has("velodyne_points") || has("velodyne")) return std::nullopt;
    const std::vector<fs::path> below = raw_drives_below(folder);
    return below.size() == 1 ? std::optional(below.front()) : std::nullopt;
  } catch (const fs::filesystem_error& error) {
    throw InputError(fmt::format("the drive cannot be read ({})", error.code().message()),
                     folder.string(), "check its permissions and its disk");
  }
}

void correct_camera(const DriveCorrection::CorrectedCamera& correction, const fs::path& file,
                    const DriveOptions& options, DriveInfo& info) {
  std::vector<Camera>& cameras = info.calibration.cameras;
  const auto camera = std::ranges::find(cameras, correction.camera, &Camera::index);
  if (camera != cameras.end()) {
    camera->T_cam_lidar = correction.T_cam_lidar;
    camera->image_delay += correction.added_delay;
    return;
  }
  std::vector<int> others = info.unused_cameras;
  if (!options.use_images || std::ranges::count(others, correction.camera) > 0) return;
  for (const Camera& present : cameras) others.push_back(present.index);
  std::ranges::sort(others);
  throw ConfigError(
      fmt::format("the drive has no camera {}", correction.camera),
      place_of(file, fmt::format("camera.{}", correction.camera)),
      fmt::format("remove the table; cameras of the drive: {}", fmt::join(others, ", ")));
}

/// Whether the drive may have an IMU that the options leave out. KITTI's raw drives have one
/// unit for both: with its positions, its rates are not read.
bool leaves_out_imu(const DriveInfo& info, const DriveOptions& options) {
  return !options.use_imu || (info.kind == "kitti-raw" && options.use_navigation);
}

void correct_imu(const DriveCorrection::CorrectedImu& correction, const fs::path& file,
                 const DriveOptions& options, DriveInfo& info) {
  if (!info.imu) {
    if (leaves_out_imu(info, options)) return;
    throw ConfigError("the drive has no IMU to correct", place_of(file, "imu"),
                      "remove the table, or give the drive imu.csv and imu.T_lidar_imu");
  }
  info.imu->T_lidar_imu = correction.T_lidar_imu;
  const TimeNs added_delay = from_seconds(correction.added_delay);
  for (ImuSample& sample : info.imu->samples) sample.time += added_delay;
}

/// InputError if `folder` is no place for a calibrated drive.
void require_free_folder(const fs::path& folder, bool force) {
  constexpr const char* kRemedy = "give another folder";
  const fs::path file = folder / kFileName;
  std::error_code ignored;
  for (const char* kitti : {"velodyne_points", "velodyne"}) {
    if (!fs::exists(folder / kitti, ignored)) continue;
    throw InputError("the folder is that of another drive", folder.string(), kRemedy);
  }
  if (!fs::exists(file, ignored)) return;
  if (!is_calibrated_drive_file(file)) {
    throw InputError("the folder is that of a drive which is no calibrated one", file.string(),
                     kRemedy);
  }
  if (!force) {
    throw InputError("the calibrated drive exists already", file.string(),
                     "use --force to replace it or give another folder");
  }
}

/// InputError if a calibrated drive in `folder` could not correct the drive.
/// @param drive, folder  absolute, without links
void require_other_drive(const fs::path& drive, const fs::path& folder) {
  const std::vector<Level> levels = levels_of(drive);
  if (drive == folder || std::ranges::count(levels, folder, &Level::drive) > 0) {
    throw InputError("the drives would correct each other in a circle", folder.string(),
                     "give another folder");
  }
  if (levels.size() < kMaxLevels) return;
  throw InputError(fmt::format("over {} drives would correct one another", kMaxLevels),
                   drive.string(), fmt::format("correct {}", levels.back().drive.string()));
}

/// The same folder for all of its names. The folder need not exist.
fs::path without_links(fs::path folder) {
  if (!folder.has_filename()) folder = folder.parent_path();
  std::error_code ignored;
  return fs::weakly_canonical(fs::absolute(folder, ignored), ignored);
}

}  // namespace

bool is_calibrated_drive_file(const fs::path& file) {
  return calibrated_document(file).has_value();
}

std::unique_ptr<FrameSource> open_calibrated_drive(const fs::path& folder,
                                                   const DriveOptions& options) {
  const std::vector<Level> levels = levels_of(folder);
  std::unique_ptr<FrameSource> drive =
      open_drive(levels.empty() ? folder : levels.back().drive, options);
  DriveInfo info = drive->info();
  info.path = folder;
  for (const Level& level : levels | std::views::reverse) {
    for (const DriveCorrection::CorrectedCamera& camera : level.correction.cameras) {
      correct_camera(camera, level.file, options, info);
    }
    if (level.correction.imu) correct_imu(*level.correction.imu, level.file, options, info);
  }
  return std::make_unique<RecalibratedSource>(std::move(drive), std::move(info));
}

std::vector<fs::path> corrected_folders(const fs::path& drive) {
  std::vector<fs::path> folders;
  for (const Level& level : levels_of(drive)) folders.push_back(level.drive);
  if (folders.empty()) return folders;
  if (const auto below = only_drive_below(folders.back())) folders.push_back(*below);
  return folders;
}

fs::path recorded_folder(const fs::path& drive) {
  const std::vector<fs::path> folders = corrected_folders(drive);
  return folders.empty() ? drive : folders.back();
}

void check_calibrated_drive(const fs::path& folder, const fs::path& drive, bool force) {
  std::error_code error;
  if (!fs::is_directory(drive, error)) {
    throw InputError("the drive does not exist", drive.string(), "give the folder of a drive");
  }
  require_free_folder(folder, force);
  require_other_drive(without_links(drive), without_links(folder));
  if (fs::exists(folder, error)) {
    check_output_path(folder / kFileName, /*force=*/true);
  } else {
    check_output_path(folder, /*force=*/true);  // its parent must be writable
  }
}

void write_calibrated_drive(const fs::path& folder, const fs::path& drive,
                            const DriveCorrection& correction, bool force) {
  check_calibrated_drive(folder, drive, force);
  std::error_code error;
  const fs::path to = without_links(drive);
  const fs::path relative = to.lexically_relative(without_links(folder));
  const std::string text = calibrated_drive_text({relative.empty() ? to : relative, correction});
  const fs::path file = folder / kFileName;
  parse_calibrated_drive(SettingsDocument::from_text(text, file.string()));  // checks the values
  fs::create_directory(folder, error);
  if (error) throw_output_error(folder, error.value());
  OutputFile output(file, force);
  output.stream() << text;
  output.commit();
}

}  // namespace fovea
