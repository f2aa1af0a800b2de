#include "fovea/drive/drive_files.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "fovea/drive/images/image_decode.h"
#include "fovea/errors.h"

namespace fovea {
namespace {

constexpr TimeNs kDefaultPeriod = kNsPerSecond / 10;  // KITTI's LiDAR turns at 10 Hz
// A LiDAR turns at 5-20 Hz; a median step outside of this means that frames were left out.
constexpr double kMinPeriod = 0.04, kMaxPeriod = 0.25;

std::string first_lines(const std::vector<int>& lines) {
  constexpr std::size_t kShown = 5;
  std::vector<int> shown;
  for (std::size_t i = 0; i < std::min(lines.size(), kShown); ++i) shown.push_back(lines[i] + 1);
  return fmt::format("{}{}", fmt::join(shown, ", "), lines.size() > kShown ? ", ..." : "");
}

}  // namespace

std::optional<TimeNs> frame_stamp(const DriveInfo& info, const TimeStamps& stamps, int index) {
  if (!info.has_time_stamps) return index * kDefaultPeriod;
  if (index < 0 || static_cast<std::size_t>(index) >= stamps.times.size()) return std::nullopt;
  return stamps.times[static_cast<std::size_t>(index)];
}

std::optional<int> first_usable_frame(const DriveInfo& info, const DriveFiles& files) {
  for (auto scan = files.scans.lower_bound(info.begin);
       scan != files.scans.end() && scan->first < info.end; ++scan) {
    const int index = scan->first;
    const bool images =
        files.images.empty() ||
        std::any_of(files.images.begin(), files.images.end(),
                    [&](const NumberedFiles& camera) { return camera.contains(index); });
    if (images && frame_stamp(info, files.stamps, index)) {
      return index;
    }
  }
  return std::nullopt;
}

ScansReached scans_reached(const Trajectory& T_local_lidar, const DriveInfo& info,
                           const DriveFiles& files) {
  ScansReached result;
  for (auto scan = files.scans.lower_bound(info.begin);
       scan != files.scans.end() && scan->first < info.end; ++scan) {
    const auto stamp = frame_stamp(info, files.stamps, scan->first);
    if (!stamp) continue;
    ++result.stamped;
    result.reached += T_local_lidar.at(*stamp) ? 1 : 0;
  }
  return result;
}

std::pair<int, int> frame_range(const NumberedFiles& scans, const DriveOptions& options,
                                const std::filesystem::path& drive) {
  const int first = scans.begin()->first, end = scans.rbegin()->first + 1;
  const std::pair<int, int> range{std::max(first, options.begin.value_or(first)),
                                  std::min(end, options.end.value_or(end))};
  if (range.first >= range.second) {
    throw ConfigError(fmt::format("frames {}:{} hold none of the drive's",
                                  options.begin.value_or(first), options.end.value_or(end)),
                      drive.string(), fmt::format("choose from {}:{}", first, end));
  }
  return range;
}

std::vector<int> choose_cameras(const std::vector<int>& present, const DriveOptions& options,
                                const std::filesystem::path& drive) {
  const auto has = [&](int camera) {
    return std::find(present.begin(), present.end(), camera) != present.end();
  };
  if (present.empty()) {
    throw InputError("the drive has no camera with both images and calibration", drive.string(),
                     "restore its image folders, or use its scans alone (--cameras none)");
  }
  if (options.cameras.empty()) {
    for (const int camera : {2, 3, 0, 1}) {
      if (has(camera)) return {camera};
    }
    return {present.front()};
  }
  for (std::size_t i = 0; i < options.cameras.size(); ++i) {
    const int camera = options.cameras[i];
    if (!has(camera)) {
      throw ConfigError(fmt::format("the drive has no camera {}", camera), drive.string(),
                        fmt::format("choose from {}", fmt::join(present, ", ")));
    }
    if (std::count(options.cameras.begin(), options.cameras.end(), camera) > 1) {
      throw ConfigError(fmt::format("camera {} is asked for twice", camera), "cameras",
                        "name each camera once");
    }
  }
  return options.cameras;
}

std::vector<int> unused_cameras(const std::vector<int>& present, const std::vector<int>& chosen) {
  std::vector<int> unused = present;
  std::erase_if(unused, [&](int camera) {
    return std::find(chosen.begin(), chosen.end(), camera) != chosen.end();
  });
  return unused;
}

void find_images(const KittiCalibration& calibration, const DriveOptions& options,
                 const std::string& folder_prefix, const std::string& subfolder, DriveInfo& info,
                 DriveFiles& files) {
  std::map<int, NumberedFiles> found;
  std::vector<int> present;
  bool has_folder = false;
  for (const auto& [index, camera] : calibration.cameras) {
    const auto folder = info.path / (folder_prefix + std::to_string(index));
    has_folder = has_folder || std::filesystem::exists(folder);
    NumberedFiles images = list_numbered_files(folder / subfolder, {".png", ".jpg", ".jpeg"});
    if (images.empty()) continue;
    present.push_back(index);
    found.emplace(index, std::move(images));
  }
  if (!has_folder && options.cameras.empty()) {
    info.notes.push_back(kNoCameraNote);
    return;
  }
  const std::vector<int> chosen = choose_cameras(present, options, info.path);
  info.unused_cameras = unused_cameras(present, chosen);
  for (const int index : chosen) {
    info.calibration.cameras.push_back(calibration.cameras.at(index));
    files.images.push_back(std::move(found.at(index)));
    const auto mask = options.masks.find(index);
    if (mask != options.masks.end()) {
      info.masks.emplace(index, read_mask(mask->second, info.calibration.cameras.back(), nullptr));
    }
  }
}

ImageMask read_mask(const std::filesystem::path& file, const Camera& camera,
                    const ImageRectifier* rectifier) {
  const Image picture = read_image(file);
  const int width = rectifier != nullptr ? rectifier->width() : camera.width;
  const int height = rectifier != nullptr ? rectifier->height() : camera.height;
  if (picture.width != width || picture.height != height) {
    throw ConfigError(fmt::format("the mask has {} x {} pixels, the images of camera {} {} x {}",
                                  picture.width, picture.height, camera.index, width, height),
                      file.string(), "give a mask of the size of the images");
  }
  return ImageMask(rectifier != nullptr ? rectifier->rectify(picture) : picture);
}

void require_cameras_of_masks(const DriveOptions& options, const DriveInfo& info) {
  for (const auto& [camera, file] : options.masks) {
    if (info.masks.contains(camera)) continue;
    throw ConfigError(fmt::format("a mask of camera {}, which is not used", camera), file.string(),
                      "name the camera in --cameras, or leave the mask out");
  }
}

void find_stamps(const std::filesystem::path& file,
                 TimeStamps (*read)(const std::filesystem::path&), DriveInfo& info,
                 DriveFiles& files) {
  const bool exists = std::filesystem::exists(file);
  if (exists) files.stamps = read(file);
  const TimeStamps& stamps = files.stamps;
  info.has_time_stamps = stamps.any();
  if (!info.has_time_stamps) {
    info.warn(fmt::format("{} {}: frames are counted as 10 Hz", file.string(),
                          exists ? "has no usable line" : "is missing"));
    return;
  }
  if (!stamps.malformed.empty()) {
    info.warn(fmt::format("{} has {} malformed lines ({}): their frames are skipped", file.string(),
                          stamps.malformed.size(), first_lines(stamps.malformed)));
  }
  if (!stamps.out_of_order.empty()) {
    info.warn(
        fmt::format("{} has {} stamps out of order (lines {}): their frames are "
                    "skipped",
                    file.string(), stamps.out_of_order.size(), first_lines(stamps.out_of_order)));
  }
  find_sweep_period(file, stamps, info);
}

bool can_be_sweep_period(double step) { return step >= kMinPeriod && step <= kMaxPeriod; }

bool find_sweep_period(const std::filesystem::path& file, const TimeStamps& stamps,
                       DriveInfo& info) {
  const std::optional<double> step = median_period(stamps);
  if (!step) return false;
  const double period = *step;
  constexpr double kShortestStep = 0.001;  // s; below, the unit is wrong
  if (period < kShortestStep) {
    throw InputError(fmt::format("stamps are {:.4g} s apart, which are no sweeps", period),
                     file.string(), "check the unit of the times");
  }
  if (can_be_sweep_period(period)) {
    info.sweep.period = period;
    return true;
  }
  info.warn(
      fmt::format("{} steps by {:.3f} s, no LiDAR's turn: a sweep is taken as "
                  "{} s",
                  file.string(), period, info.sweep.period));
  return false;
}

}  // namespace fovea
