#include "fovea/drive/generic_drive.h"

#include <fmt/format.h>

#include <algorithm>

#include "fovea/drive/described_camera.h"
#include "fovea/drive/drive_description.h"
#include "fovea/drive/drive_files.h"
#include "fovea/drive/drive_stamps.h"
#include "fovea/drive/images/image_decode.h"
#include "fovea/drive/lidar_scans.h"
#include "fovea/drive/navigation/generic_navigation.h"
#include "fovea/drive/navigation/imu_table.h"
#include "fovea/drive/nearest_images.h"
#include "fovea/errors.h"

namespace fovea {
namespace {

class GenericDrive {
 public:
  GenericDrive(const std::filesystem::path& path, const DriveOptions& options)
      : options_(options), description_(read_drive_description(path / "drive.toml")) {
    info_.path = path;
    info_.kind = "generic";
    info_.sweep_compensated = description_.lidar.sweep_compensated;
  }

  std::unique_ptr<FrameSource> open() {
    find_scans();
    find_scan_stamps();
    find_scan_format();
    find_further_lidars();
    if (options_.use_images) find_cameras();
    if (options_.use_navigation) find_navigation();
    if (options_.use_imu) find_imu();
    return make_frame_source(std::move(info_), std::move(files_));
  }

 private:
  void find_scans() {
    files_.scans = list_scans(info_.path, description_.lidar);
    if (files_.scans.empty()) {
      throw InputError("the drive has no scan", (info_.path / description_.lidar.folder).string(),
                       "put scans there as NUMBER.pcd, .ply or .bin (docs/drives.md)");
    }
    std::tie(info_.begin, info_.end) = frame_range(files_.scans, options_, info_.path);
  }

  void find_scan_stamps() {
    const std::filesystem::path file = info_.path / description_.lidar.folder / "stamps.csv";
    files_.stamps_name_scans = true;
    files_.stamps = read_stamps_of_scans(file, files_.scans, info_);
    info_.has_time_stamps = files_.stamps.any();
    if (!info_.has_time_stamps) {
      info_.warn(fmt::format("{} {}: scans are counted as 10 Hz", file.string(),
                             std::filesystem::exists(file) ? "has no usable line" : "is missing"));
      return;
    }
    if (!description_.lidar.sweep.period && find_sweep_period(file, files_.stamps, info_)) {
      stamp_step_ = info_.sweep.period;
    }
  }

  void find_scan_format() {
    const auto stamp = [&](int scan) { return frame_stamp(info_, files_.stamps, scan); };
    const ScanReading reading =
        recognize_scans(info_.path, description_.lidar, files_.scans, stamp, stamp_step_, info_);
    files_.scan_format = reading.format;
    info_.sweep = reading.sweep;
    sweep_middle_ = reading.sweep_middle;
    has_times_ = reading.has_times;
  }

  /// Scans of several LiDARs are merged as measured: each point has its time.
  void find_further_lidars() {
    if (description_.further_lidars.empty()) return;
    info_.sweep_compensated = false;
    files_.first_lidar_compensated = description_.lidar.sweep_compensated;
    const auto assumes_times = [](bool has_times, bool is_compensated) {
      return !has_times && !is_compensated;
    };
    info_.times_by_azimuth = assumes_times(has_times_, files_.first_lidar_compensated);
    const NumberedTimes frames = info_.has_time_stamps ? stamps_of_scans() : NumberedTimes();
    std::vector<int> numbers;
    for (const auto& [number, file] : files_.scans) numbers.push_back(number);
    add_lidar(description_.lidar.name, info_.sweep, RigidMotion::Identity());
    for (const LidarDescription& lidar : description_.further_lidars) {
      const FurtherLidar& further = files_.further_lidars.emplace_back(
          find_further_lidar(info_.path, lidar, numbers, frames, sweep_middle_, info_));
      info_.times_by_azimuth |= assumes_times(further.has_times, further.sweep_compensated);
      add_lidar(lidar.name, further.sweep, lidar.T_lidar_sensor);
    }
  }

  void add_lidar(const std::string& name, const SweepTiming& sweep,
                 const RigidMotion& T_lidar_sensor) {
    MountedLidar& lidar = info_.lidars.emplace_back();
    lidar.profile.name = name;
    lidar.profile.sweep = sweep;
    lidar.T_lidar_sensor = T_lidar_sensor;
  }

  NumberedTimes stamps_of_scans() const {
    NumberedTimes scans;
    for (const auto& [scan, path] : files_.scans) {
      if (const auto time = frame_stamp(info_, files_.stamps, scan)) scans.emplace(scan, *time);
    }
    return scans;
  }

  /// The images of those cameras that have any, by camera number.
  std::map<int, NumberedFiles> list_images() {
    std::map<int, NumberedFiles> images;
    for (const CameraDescription& camera : description_.cameras) {
      const std::filesystem::path folder = info_.path / camera.folder;
      NumberedFiles files = list_numbered_files(folder, {".png", ".jpg", ".jpeg"});
      if (files.empty()) {
        info_.warn(fmt::format("camera {} ({}) has no image in {}: it is left out", camera.index,
                               camera.name, folder.string()));
      } else {
        images.emplace(camera.index, std::move(files));
      }
    }
    return images;
  }

  void find_cameras() {
    if (description_.cameras.empty() && options_.cameras.empty()) {
      info_.notes.push_back(kNoCameraNote);
      return;
    }
    std::map<int, NumberedFiles> images = list_images();
    std::vector<int> present;
    present.reserve(images.size());
    for (const auto& [index, files] : images) present.push_back(index);
    const std::vector<int> chosen = choose_cameras(present, options_, info_.path);
    info_.unused_cameras = unused_cameras(present, chosen);
    for (const int index : chosen) {
      const CameraDescription& camera =
          *std::find_if(description_.cameras.begin(), description_.cameras.end(),
                        [&](const CameraDescription& c) { return c.index == index; });
      add_camera(camera, images.at(index));
    }
  }

  void add_camera(const CameraDescription& described, const NumberedFiles& images) {
    auto next = images.begin();
    require_image_size(
        described,
        [&]() -> std::optional<Image> {
          if (next == images.end()) return std::nullopt;
          return read_image((next++)->second);
        },
        images.begin()->second.parent_path());
    DescribedCamera used = described_camera(described, info_.path / "drive.toml");
    Camera& camera = used.camera;
    info_.image_offsets.emplace_back();
    info_.image_exposures.emplace_back();
    files_.images.push_back(images_of_scans(described, images, camera));
    info_.calibration.cameras.push_back(camera);
    if (auto mask = find_mask(described, used, options_, info_.path)) {
      info_.masks.emplace(camera.index, std::move(*mask));
    }
    files_.rectifiers.push_back(std::move(used.rectifier));
  }

  /// The images by the numbers of the scans they belong to; sets the camera's median delay, the
  /// offsets of its images from that median, and their exposures.
  NumberedFiles images_of_scans(const CameraDescription& described, const NumberedFiles& images,
                                Camera& camera) {
    const std::filesystem::path file = info_.path / described.folder / "stamps.csv";
    if (!std::filesystem::exists(file)) return images;
    if (!info_.has_time_stamps) {
      info_.warn(file.string() + " is not used: the scans have no stamps");
      return images;
    }
    const NumberedTimes scans = stamps_of_scans();
    NumberedTimes times = read_image_stamps(file, scans, info_);
    std::erase_if(times, [&](const auto& stamp) { return !images.contains(stamp.first); });
    ImageMatches matches = match_nearest(scans, times, sweep_middle_, description_.image_tolerance);
    if (matches.image_of_scan.empty()) {
      throw InputError(fmt::format("no image of camera {} belongs to a scan: {}", described.name,
                                   why_none_matches(scans, times, description_.image_tolerance)),
                       file.string(),
                       "give stamps of one clock, or leave the camera out (--cameras)");
    }
    matches.median_delay = described.stamp_delay.value_or(matches.median_delay);
    camera.image_delay += matches.median_delay;
    note_matches(described, matches, scans.size(), description_.image_tolerance, info_);
    info_.image_stamps_are_capture_times = true;
    const std::map<int, double> exposures = read_image_exposures(file, info_);
    NumberedFiles result;
    for (const auto& [scan, image] : matches.image_of_scan) {
      const auto exposure = exposures.find(image);
      if (exposure != exposures.end()) info_.image_exposures.back()[scan] = exposure->second;
      result[scan] = images.at(image);
      const double delay = seconds(times.at(image) - scans.at(scan));
      info_.image_offsets.back()[scan] = delay - matches.median_delay;
    }
    return result;
  }

  void find_navigation() {
    const int first = first_usable_frame(info_, files_).value_or(info_.begin);
    const TimeNs origin_time = frame_stamp(info_, files_.stamps, first).value_or(0);
    GenericNavigation navigation =
        read_generic_navigation(info_.path, description_, origin_time, period_of(files_.stamps));
    info_.append(navigation);
    if (!navigation.T_local_lidar || !covers_scans(*navigation.T_local_lidar)) return;
    info_.calibration.T_imu_lidar = description_.T_body_lidar;
    info_.navigation = std::move(navigation.T_local_lidar);
    info_.navigation_accuracy = std::move(navigation.accuracy);
    info_.origin = navigation.origin;
    info_.coordinates = description_.coordinates;
  }

  void find_imu() {
    InertialTables tables =
        read_inertial_tables(info_.path, description_, period_of(files_.stamps));
    info_.append(tables);
    std::tie(info_.imu, info_.wheels) = std::pair(std::move(tables.imu), std::move(tables.wheels));
  }

  /// Notes the scans of the range that have no pose; false if none has one.
  bool covers_scans(const Trajectory& T_local_lidar) {
    const ScansReached reach = scans_reached(T_local_lidar, info_, files_);
    if (reach.reached == reach.stamped) return true;
    info_.warn(
        fmt::format("poses or positions reach {} of {} scans{}", reach.reached, reach.stamped,
                    reach.reached == 0 ? ", are their times of one clock? No navigation" : ""));
    return reach.reached > 0;
  }

  DriveOptions options_;
  DriveDescription description_;
  DriveInfo info_;
  DriveFiles files_;
  std::optional<double> stamp_step_;  // s, where it can be a sweep's period
  double sweep_middle_ = 0;           // s after a scan's stamp
  bool has_times_ = false;            // of points, in the files of the first LiDAR
};

}  // namespace

std::unique_ptr<FrameSource> open_generic_drive(const std::filesystem::path& path,
                                                const DriveOptions& options) {
  return GenericDrive(path, options).open();
}

}  // namespace fovea
