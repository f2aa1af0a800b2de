#include "fovea/simulation/lidar_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "fovea/base/angle.h"
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
}

void check_kitti_format(const LidarOptions& lidar) {
  const LidarDataSheet& sheet = lidar_data_sheet(lidar.model);
  if (!sheet.rosette) return;
  reject(
      fmt::format("the scans of a {} need the times of their points, for which KITTI's format has "
                  "no place",
                  sheet.name),
      "lidar.model", "use --format generic");
}

}  // namespace fovea
