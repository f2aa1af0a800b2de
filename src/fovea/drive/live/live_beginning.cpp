#include "fovea/drive/live/live_beginning.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "fovea/drive/described_camera.h"
#include "fovea/drive/drive_files.h"
#include "fovea/drive/lidar_scans.h"
#include "fovea/drive/live/scan_points.h"
#include "fovea/errors.h"

namespace fovea {
namespace {

namespace fs = std::filesystem;

using Scans = std::vector<std::shared_ptr<const LiveScan>>;

template <class Item>
NumberedTimes times_of(const std::vector<std::shared_ptr<const Item>>& items) {
  NumberedTimes times;
  for (std::size_t i = 0; i < items.size(); ++i) times.emplace(int(i), items[i]->stamp);
  return times;
}

TimeStamps stamps_of(const Scans& scans) {
  TimeStamps stamps;
  for (const auto& scan : scans) stamps.times.emplace_back(scan->stamp);
  return stamps;
}

/// Passes over scans that cannot be used.
FirstScans show(const Scans& scans, const std::string& name) {
  FirstScans first;
  for (const auto& scan : scans) {
    if (first.numbers.size() == std::size_t(kFirstScans)) break;
    try {
      first.numbers.push_back(numbers_of(scan->points, scan->stamp, name));
    } catch (const InputError&) {
      continue;
    }
  }
  first.middle = [&scans, name](const ScanFormat& format) -> std::optional<double> {
    for (const auto& scan : scans) {
      try {
        return sweep_middle(usable_points(scan->points, format, scan->stamp, name).points);
      } catch (const InputError&) {
        continue;
      }
    }
    return std::nullopt;
  };
  return first;
}

class Builder {
 public:
  Builder(const DriveDescription& description, const DriveOptions& options, const fs::path& name,
          const FirstData& first)
      : description_(description), options_(options), first_(first), toml_(name / "drive.toml") {
    info_.path = name;
    info_.kind = kLiveDrive;
    decoder_.name = name;
  }

  LiveBeginning build() {
    find_lidars();
    if (options_.use_images) find_cameras();
    return std::move(beginning_);
  }

 private:
  void find_lidars() {
    info_.sweep_compensated = description_.lidar.sweep_compensated;
    const TimeStamps stamps = stamps_of(first_.scans);
    std::optional<double> step;
    if (!description_.lidar.sweep.period && find_sweep_period(info_.path, stamps, info_)) {
      step = info_.sweep.period;
    }
    decoder_.lidar = lidar(description_.lidar, first_.scans, step);
    info_.sweep = decoder_.lidar.sweep;
    sensors_.period = from_seconds(median_period(stamps).value_or(info_.sweep.period));
    if (!description_.further_lidars.empty()) find_further_lidars();
  }

  LiveLidar lidar(const LidarDescription& described, const Scans& scans,
                  std::optional<double> step) {
    const FirstScans first = show(scans, info_.path.string());
    const ScanReading reading = recognize_scans(toml_, described, first, step, info_);
    return {described.name,          reading.format,
            reading.sweep,           described.sweep_compensated,
            reading.sweep_middle,    reading.has_times,
            described.T_lidar_sensor};
  }

  void add_lidar(const LiveLidar& lidar) {
    MountedLidar& mounted = info_.lidars.emplace_back();
    mounted.profile.name = lidar.name;
    mounted.profile.sweep = lidar.sweep;
    mounted.T_lidar_sensor = lidar.T_lidar_sensor;
    info_.times_by_azimuth |= !lidar.has_times && !lidar.sweep_compensated;
  }

  void find_further_lidars() {
    if (std::all_of(first_.further_scans.begin(), first_.further_scans.end(),
                    [](const Scans& scans) { return scans.empty(); })) {
      info_.warn("the further LiDARs have sent no scan: they are left out");
      return;
    }
    info_.sweep_compensated = false;
    add_lidar(decoder_.lidar);
    for (std::size_t i = 0; i < description_.further_lidars.size(); ++i) {
      const LidarDescription& described = description_.further_lidars[i];
      const Scans& scans = first_.further_scans[i];
      if (scans.empty()) {
        info_.warn(fmt::format("LiDAR {} has sent no scan: it is left out", described.name));
        continue;
      }
      std::optional<double> step = median_period(stamps_of(scans));
      if (step && !can_be_sweep_period(*step)) step.reset();
      const LiveLidar& further =
          decoder_.further_lidars.emplace_back(lidar(described, scans, step));
      add_lidar(further);
      sensors_.further_lidars.push_back(i);
      sensors_.further_places.push_back(
          {from_seconds(decoder_.lidar.sweep_middle - further.sweep_middle),
           from_seconds(further.sweep.period / 2)});
    }
  }

  void find_cameras() {
    if (description_.cameras.empty() && options_.cameras.empty()) {
      info_.notes.push_back(kNoCameraNote);
      return;
    }
    std::vector<int> present;
    std::map<int, std::size_t> place;
    for (std::size_t i = 0; i < description_.cameras.size(); ++i) {
      const CameraDescription& camera = description_.cameras[i];
      place[camera.index] = i;
      if (!first_.images[i].empty()) {
        present.push_back(camera.index);
      } else if (options_.cameras.empty() || is_chosen(camera.index)) {
        info_.warn(fmt::format("camera {} ({}) has sent no image: it is left out", camera.index,
                               camera.name));
      }
    }
    if (present.empty()) {
      info_.warn(kNoCameraNote);
      return;
    }
    DriveOptions there = options_;
    std::erase_if(there.cameras, [&](int camera) {
      return std::find(present.begin(), present.end(), camera) == present.end();
    });
    if (there.cameras.empty() && !options_.cameras.empty()) {
      info_.warn(kNoCameraNote);
      return;
    }
    const std::vector<int> chosen = choose_cameras(present, there, info_.path);
    info_.unused_cameras = unused_cameras(present, chosen);
    for (const int index : chosen) add_camera(place.at(index));
    info_.image_stamps_are_capture_times = true;
  }

  bool is_chosen(int camera) const {
    return std::find(options_.cameras.begin(), options_.cameras.end(), camera) !=
           options_.cameras.end();
  }

  void add_camera(std::size_t place) {
    const CameraDescription& described = description_.cameras[place];
    const auto& images = first_.images[place];
    const fs::path where = info_.path / ("images of camera " + described.name);
    std::size_t next = 0;
    require_image_size(
        described,
        [&]() -> std::optional<Image> {
          if (next == images.size()) return std::nullopt;
          return pixels_of(*images[next++], where.string());
        },
        where);
    DescribedCamera used = described_camera(described, toml_);
    const NumberedTimes scans = times_of(first_.scans), times = times_of(images);
    ImageMatches matches =
        match_nearest(scans, times, decoder_.lidar.sweep_middle, description_.image_tolerance);
    if (matches.image_of_scan.empty()) {
      info_.warn(fmt::format("no image of camera {} belongs to a scan, it is left out: {}",
                             described.name,
                             why_none_matches(scans, times, description_.image_tolerance)));
      info_.unused_cameras.push_back(described.index);
      return;
    }
    matches.median_delay = described.stamp_delay.value_or(matches.median_delay);
    used.camera.image_delay += matches.median_delay;
    if (auto mask = find_mask(described, used, options_, {})) {
      info_.masks.emplace(described.index, std::move(*mask));
    }
    info_.calibration.cameras.push_back(used.camera);
    decoder_.cameras.push_back(
        {described.name, used.camera, std::move(used.rectifier), matches.median_delay});
    sensors_.cameras.push_back(place);
    sensors_.image_places.push_back(
        {from_seconds(matches.median_delay), from_seconds(description_.image_tolerance)});
  }

  const DriveDescription& description_;
  const DriveOptions& options_;
  const FirstData& first_;
  const fs::path toml_;
  LiveBeginning beginning_;
  DriveInfo& info_ = beginning_.info;
  LiveDecoder& decoder_ = beginning_.decoder;
  FrameQueue::Sensors& sensors_ = beginning_.sensors;
};

}  // namespace

std::vector<int> camera_numbers(const DriveDescription& description) {
  std::vector<int> numbers;
  numbers.reserve(description.cameras.size());
  for (const CameraDescription& camera : description.cameras) numbers.push_back(camera.index);
  return numbers;
}

LiveBeginning find_sensors(const DriveDescription& description, const DriveOptions& options,
                           const fs::path& name, const FirstData& first) {
  return Builder(description, options, name, first).build();
}

}  // namespace fovea
