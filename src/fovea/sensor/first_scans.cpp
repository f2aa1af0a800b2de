#include "fovea/sensor/first_scans.h"

#include <algorithm>

#include "fovea/base/errors.h"

namespace fovea {

FirstScans read_first_scans(const NumberedFiles& scans, const ScanFormat& format, int count,
                            const std::function<std::optional<TimeNs>(int scan)>& stamp) {
  FirstScans first;
  for (const auto& [scan, file] : scans) {
    const std::optional<TimeNs> time = stamp(scan);
    if (!time) continue;
    try {
      const PointCloud points = read_lidar_scan(file, format, *time).points;
      first.scale.add(points.intensity);
      if (!first.any && !points.time.empty()) {
        const auto [begin, end] = std::minmax_element(points.time.begin(), points.time.end());
        first.sweep_middle = 0.5 * (double(*begin) + double(*end));
      }
      first.any = true;
      if (--count <= 0) break;
    } catch (const InputError&) {
      continue;  // load() reports the damage
    }
  }
  return first;
}

}  // namespace fovea
