// KITTI raw drives: DATE/DATE_drive_NNNN_sync.
#include <fmt/format.h>

#include <algorithm>

#include "fovea/drive/drive_files.h"
#include "fovea/drive/kitti/kitti_drives.h"
#include "fovea/drive/navigation/imu_table.h"
#include "fovea/drive/navigation/navigation.h"
#include "fovea/errors.h"

namespace fovea {
namespace {

/// The folder above the drive's, for "." and "drive/", too.
std::filesystem::path date_folder(const std::filesystem::path& drive) {
  const auto absolute = std::filesystem::absolute(drive / "").lexically_normal();
  return absolute.parent_path().parent_path();
}

struct OxtsFolder {
  std::vector<StampedOxts> records;         ///< usable ones
  std::map<int, std::string> why_unusable;  ///< by record number
};

/// @param stamps  of the records; absent where the drive counts as 10 Hz: a synced drive has one
///                record a scan, so its number is its time
OxtsFolder read_oxts_folder(const NumberedFiles& files, const std::optional<TimeStamps>& stamps,
                            const DriveInfo& info) {
  OxtsFolder folder;
  for (const auto& [index, file] : files) {
    const std::optional<TimeNs> time = frame_stamp(info, stamps.value_or(TimeStamps{}), index);
    const auto record = read_oxts(file);
    if (const auto* why = std::get_if<std::string>(&record)) {
      folder.why_unusable[index] = file.string() + " " + *why;
    } else if (!time) {
      folder.why_unusable[index] = file.string() + " has no usable time stamp";
    } else {
      folder.records.push_back({*time, std::get<OxtsRecord>(record)});
    }
  }
  return folder;
}

/// Notes the unusable records, and the frames of the range that have none of their own.
void note_bad_records(const NumberedFiles& oxts, const OxtsFolder& folder, const DriveFiles& files,
                      DriveInfo& info) {
  if (!folder.why_unusable.empty()) {
    info.warn(fmt::format("{} of {} GPS/INS records cannot be used (the first: {})",
                          folder.why_unusable.size(), oxts.size(),
                          folder.why_unusable.begin()->second));
  }
  std::vector<int> without;
  for (auto scan = files.scans.lower_bound(info.begin);
       scan != files.scans.end() && scan->first < info.end; ++scan) {
    if (!oxts.contains(scan->first)) without.push_back(scan->first);
  }
  if (without.empty()) return;
  info.warn(fmt::format("{} frames have no GPS/INS record (the first: {})", without.size(),
                        without.front()));
}

/// The poses of records, without positions that are far from the others, which a note counts.
std::vector<GeodeticPose> consistent_poses(const std::vector<StampedOxts>& records,
                                           DriveInfo& info) {
  const std::vector<GeodeticPose> all = geodetic_poses(records);
  const std::vector<bool> far = far_positions(all);
  std::vector<GeodeticPose> poses;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (!far[i]) poses.push_back(all[i]);
  }
  if (poses.size() < all.size()) {
    info.warn(
        fmt::format("{} of {} GPS/INS records cannot be used: a position too far from the others",
                    all.size() - poses.size(), all.size()));
  }
  return poses;
}

/// Fills info.navigation and info.origin, or notes why there is none.
void find_navigation(const KittiCalibration& calibration, DriveInfo& info, DriveFiles& files) {
  const std::filesystem::path folder = info.path / "oxts";
  const auto without = [&](const std::string& why) {
    info.warn(why + ": no navigation, the map will not be georeferenced");
  };
  const NumberedFiles oxts = list_numbered_files(folder / "data", {".txt"});
  if (oxts.empty()) return without((folder / "data").string() + " has no record");
  if (!calibration.T_imu_lidar) return without("calib_imu_to_velo.txt is missing");

  std::optional<TimeStamps> stamps;
  if (info.has_time_stamps) {
    const std::filesystem::path file = folder / "timestamps.txt";
    if (!std::filesystem::exists(file)) return without(file.string() + " is missing");
    stamps = read_date_times(file);
  }
  const OxtsFolder records = read_oxts_folder(oxts, stamps, info);
  if (records.records.empty()) {
    return without(
        "no GPS/INS record can be used (the first: " + records.why_unusable.begin()->second + ")");
  }
  note_bad_records(oxts, records, files, info);
  const std::vector<GeodeticPose> poses = consistent_poses(records.records, info);
  if (poses.empty()) return without("positions of the GPS/INS records contradict each other");
  const std::optional<int> first = first_usable_frame(info, files);
  const TimeNs origin_time =
      first ? *frame_stamp(info, files.stamps, *first) : records.records.front().time;
  Navigation navigation = navigation_of(poses, *calibration.T_imu_lidar, origin_time);
  if (scans_reached(navigation.trajectory, info, files).reached == 0) {
    return without("GPS/INS records reach no scan, are their times of one clock?");
  }
  if (!navigation.origin) info.warn(no_fix_note(folder / "data"));
  info.calibration.T_imu_lidar = calibration.T_imu_lidar;
  info.navigation = std::move(navigation.trajectory);
  info.navigation_accuracy = std::move(navigation.accuracy);
  info.origin = navigation.origin;
}

/// The rates and accelerations of GPS/INS whose positions are not wanted.
void find_imu(const KittiCalibration& calibration, DriveInfo& info) {
  const std::filesystem::path folder = info.path / "oxts", stamps = folder / "timestamps.txt";
  if (!info.has_time_stamps || !calibration.T_imu_lidar || !std::filesystem::exists(stamps)) return;
  const NumberedFiles oxts = list_numbered_files(folder / "data", {".txt"});
  const OxtsFolder records = read_oxts_folder(oxts, read_date_times(stamps), info);
  ImuData imu;
  imu.T_lidar_imu = calibration.T_imu_lidar->inverse();
  for (const StampedOxts& record : records.records) {
    if (!imu.samples.empty() && record.time <= imu.samples.back().time) continue;
    imu.samples.push_back({record.time, record.record.rate, record.record.force});
  }
  if (imu.samples.size() < 2) return;
  report_faults(imu.samples, folder / "data", info);
  info.imu = std::move(imu);
}

}  // namespace

std::unique_ptr<FrameSource> open_kitti_raw(const std::filesystem::path& path,
                                            const DriveOptions& options) {
  DriveInfo info;
  DriveFiles files;
  info.path = path;
  info.kind = "kitti-raw";
  const std::filesystem::path scans = path / "velodyne_points";
  files.scans = list_numbered_files(scans / "data", {".bin"});
  if (files.scans.empty()) {
    throw InputError("the drive has no scan", (scans / "data" / "*.bin").string(),
                     "use a synced and rectified drive (DATE_drive_NNNN_sync) with its scans");
  }
  std::tie(info.begin, info.end) = frame_range(files.scans, options, path);
  const KittiCalibration calibration = read_kitti_raw_calibration(date_folder(path));
  if (options.use_images) find_images(calibration, options, "image_0", "data", info, files);
  find_stamps(scans / "timestamps.txt", read_date_times, info, files);
  if (options.use_navigation) {
    find_navigation(calibration, info, files);
  } else if (options.use_imu) {
    find_imu(calibration, info);
  }
  return make_frame_source(std::move(info), std::move(files));
}

std::vector<std::filesystem::path> raw_drives_below(const std::filesystem::path& root) {
  std::vector<std::filesystem::path> drives;
  for (const auto& date : std::filesystem::directory_iterator(root)) {
    if (!date.is_directory()) continue;
    std::error_code closed;  // a folder that is none of ours and may not be looked into
    for (const auto& drive : std::filesystem::directory_iterator(date.path(), closed)) {
      const std::string name = drive.path().filename().string();
      if (name.starts_with(date.path().filename().string() + "_drive_") &&
          name.ends_with("_sync") &&
          std::filesystem::is_directory(drive.path() / "velodyne_points")) {
        drives.push_back(drive.path());
      }
    }
  }
  std::sort(drives.begin(), drives.end());
  return drives;
}

}  // namespace fovea
