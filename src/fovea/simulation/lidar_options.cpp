#include "fovea/simulation/lidar_options.h"

#include "fovea/simulation/option_checks.h"

namespace fovea {

void check(const LidarOptions& lidar) {
  check_range("lidar.period", lidar.period, 0.04, 0.25, "s");
  check_range("lidar.columns", lidar.columns, 8, 20'000);
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

}  // namespace fovea
