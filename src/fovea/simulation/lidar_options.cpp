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

void check_elevations(const LidarOptions& lidar, const std::string& table) {
  const std::string key = table + ".elevations";
  const std::vector<double>& elevations = lidar.elevations;
  if (elevations.empty()) return;
  if (lidar_data_sheet(lidar.model).rosette) {
    reject(fmt::format("a {} has no rings", lidar_data_sheet(lidar.model).name), key,
           "leave it out, or choose a lidar.model that rotates");
  }
  if (elevations.size() > kMaxRings) {
    reject(fmt::format("there are {} rings", elevations.size()), key,
           fmt::format("give at most {}", kMaxRings));
  }
  for (const double elevation : elevations) check_degrees(key, elevation, -90, 90);
  if (std::adjacent_find(elevations.begin(), elevations.end(), std::less_equal<>()) !=
      elevations.end()) {
    reject("the rings are not in order, or one of them is there twice", key,
           "give each elevation once, highest first");
  }
}

/// A key of the sweep that has another value than KITTI's; nothing if there is none.
std::optional<std::string_view> unusual_sweep_key(const LidarOptions& lidar) {
  const SweepTiming kitti;
  if (lidar.direction != kitti.direction) return "direction";
  if (lidar.start_azimuth != kitti.start_azimuth) return "start_azimuth";
  if (lidar.stamp_phase != kitti.stamp_phase) return "stamp_phase";
  return std::nullopt;
}

void check_sweep(const LidarOptions& lidar, const std::string& table) {
  check_degrees(table + ".start_azimuth", lidar.start_azimuth, -360, 360);
  check_range(table + ".stamp_phase", lidar.stamp_phase, 0, 1);
  const auto key = unusual_sweep_key(lidar);
  if (!lidar_data_sheet(lidar.model).rosette || !key || key == "stamp_phase") return;
  reject(fmt::format("a {} does not rotate", lidar_data_sheet(lidar.model).name),
         fmt::format("{}.{}", table, *key), "leave it out, or choose a lidar.model that rotates");
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

std::string lidar_table(std::size_t number) {
  return number == 0 ? "lidar" : fmt::format("lidar_{}", number + 1);
}

void check(const LidarOptions& lidar, const std::string& table) {
  const auto key = [&](const char* name) { return table + "." + name; };
  check_range(key("period"), lidar.period, 0.04, 0.25, "s");
  if (lidar.columns != 0) check_range(key("columns"), lidar.columns, 8, kMaxColumns);
  check_elevations(lidar, table);
  check_range(key("min_range"), lidar.min_range, 0, 100, "m");
  check_range(key("max_range"), lidar.max_range, 1, 1000, "m");
  if (lidar.max_range <= lidar.min_range) {
    reject("the longest range is not beyond the shortest", key("max_range"),
           "give more than min_range");
  }
  check_range(key("range_noise"), lidar.range_noise, 0, 1, "m");
  check_range(key("range_resolution"), lidar.range_resolution, 0, 1, "m");
  check_range(key("dropouts"), lidar.dropouts, 0, 100);
  check_range(key("height"), lidar.height, 0.3, 5, "m");
  check_degrees(key("roll"), lidar.roll, -360, 360);
  check_degrees(key("pitch"), lidar.pitch, -360, 360);
  check_degrees(key("yaw"), lidar.yaw, -360, 360);
  check_sweep(lidar, table);
}

void check(const std::vector<FurtherLidarOptions>& lidars) {
  for (std::size_t k = 0; k < lidars.size(); ++k) {
    const std::string table = lidar_table(k + 1);
    check(lidars[k].lidar, table);
    check_range(table + ".forward", lidars[k].forward, -10, 10, "m");
    check_range(table + ".left", lidars[k].left, -10, 10, "m");
    check_range(table + ".stamp_offset", lidars[k].stamp_offset, -0.1, 0.1, "s");
  }
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
    reject("KITTI's sweeps turn clockwise from behind and are stamped in the middle",
           fmt::format("lidar.{}", *key), "use --format generic");
  }
}

}  // namespace fovea
