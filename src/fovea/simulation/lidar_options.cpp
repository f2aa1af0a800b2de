#include "fovea/simulation/lidar_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <string_view>

#include "fovea/core/angle.h"
#include "fovea/simulation/option_checks.h"

namespace fovea {
namespace {

constexpr int kMaxColumns = 200'000;
/// A truth record has one byte for the ring (docs/simulator.md).
constexpr std::size_t kMaxRings = 256;

void check_elevations(const LidarOptions& lidar) {
  constexpr const char* kKey = "lidar.elevations";
  const std::vector<double>& elevations = lidar.elevations;
  if (elevations.empty()) return;
  if (lidar_data_sheet(lidar.model).rosette) {
    reject(fmt::format("a {} has no rings", lidar_data_sheet(lidar.model).name), kKey,
           "leave it out, or choose a lidar.model that rotates");
  }
  if (elevations.size() > kMaxRings) {
    reject(fmt::format("there are {} rings", elevations.size()), kKey,
           fmt::format("give at most {}", kMaxRings));
  }
  for (const double elevation : elevations) check_degrees(kKey, elevation, -90, 90);
  if (std::adjacent_find(elevations.begin(), elevations.end(), std::less_equal<>()) !=
      elevations.end()) {
    reject("the rings are not in order, or one of them is there twice", kKey,
           "give each elevation once, highest first");
  }
}

/// A key of the sweep that has another value than KITTI's; nothing if there is none.
std::optional<std::string_view> unusual_sweep_key(const LidarOptions& lidar) {
  const SweepTiming kitti;
  if (lidar.direction != kitti.direction) return "lidar.direction";
  if (lidar.start_azimuth != kitti.start_azimuth) return "lidar.start_azimuth";
  if (lidar.stamp_phase != kitti.stamp_phase) return "lidar.stamp_phase";
  return std::nullopt;
}

void check_sweep(const LidarOptions& lidar) {
  check_degrees("lidar.start_azimuth", lidar.start_azimuth, -360, 360);
  check_range("lidar.stamp_phase", lidar.stamp_phase, 0, 1);
  const auto key = unusual_sweep_key(lidar);
  if (!lidar_data_sheet(lidar.model).rosette || !key || key == "lidar.stamp_phase") return;
  reject(fmt::format("a {} does not rotate", lidar_data_sheet(lidar.model).name), *key,
         "leave it out, or choose a lidar.model that rotates");
}

}  // namespace

void set_model(LidarOptions& lidar, LidarModel model) {
  const LidarDataSheet& before = lidar_data_sheet(lidar.model);
  const LidarDataSheet& sheet = lidar_data_sheet(model);
  lidar.model = model;
  lidar.elevations.clear();
  lidar.period = sheet.period;
  lidar.columns = model == LidarModel::kHdl64 ? LidarOptions().columns : 0;
  lidar.min_range = sheet.min_range;
  lidar.max_range = sheet.max_range;
  lidar.range_noise *= sheet.range_noise / before.range_noise;
  lidar.range_resolution *= sheet.range_resolution / before.range_resolution;
}

const std::vector<double>& ring_elevations(const LidarOptions& lidar) {
  return lidar.elevations.empty() ? lidar_data_sheet(lidar.model).elevations : lidar.elevations;
}

int sweep_columns(const LidarOptions& lidar) {
  if (lidar.columns > 0) return lidar.columns;
  return static_cast<int>(std::lround(lidar_data_sheet(lidar.model).firing_rate * lidar.period));
}

SweepTiming sweep_timing_of(const LidarOptions& lidar) {
  return {lidar.period, lidar.direction, lidar.start_azimuth, lidar.stamp_phase};
}

bool has_kittis_sweep(const LidarOptions& lidar) { return !unusual_sweep_key(lidar); }

double sweep_middle(const LidarOptions& lidar) { return (0.5 - lidar.stamp_phase) * lidar.period; }

void check(const LidarOptions& lidar) {
  check_range("lidar.period", lidar.period, 0.04, 0.25, "s");
  if (lidar.columns != 0) check_range("lidar.columns", lidar.columns, 8, kMaxColumns);
  check_elevations(lidar);
  check_range("lidar.min_range", lidar.min_range, 0, 100, "m");
  check_range("lidar.max_range", lidar.max_range, 1, 1000, "m");
  if (lidar.max_range <= lidar.min_range) {
    reject("the longest range is not beyond the shortest", "lidar.max_range",
           "give more than lidar.min_range");
  }
  check_range("lidar.range_noise", lidar.range_noise, 0, 1, "m");
  check_range("lidar.range_resolution", lidar.range_resolution, 0, 1, "m");
  check_range("lidar.dropouts", lidar.dropouts, 0, 100);
  check_range("lidar.height", lidar.height, 0.3, 5, "m");
  check_degrees("lidar.roll", lidar.roll, -360, 360);
  check_degrees("lidar.pitch", lidar.pitch, -360, 360);
  check_degrees("lidar.yaw", lidar.yaw, -360, 360);
  check_sweep(lidar);
}

void check_kitti_format(const LidarOptions& lidar) {
  const LidarDataSheet& sheet = lidar_data_sheet(lidar.model);
  if (sheet.rosette) {
    reject(fmt::format("the scans of a {} need the times of their points, for which KITTI's format "
                       "has no place",
                       sheet.name),
           "lidar.model", "use --format generic");
  }
  if (const auto key = unusual_sweep_key(lidar)) {
    reject("KITTI's sweeps turn clockwise from behind and are stamped in the middle", *key,
           "use --format generic");
  }
}

}  // namespace fovea
