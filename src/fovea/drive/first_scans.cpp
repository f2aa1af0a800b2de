#include "fovea/drive/first_scans.h"

#include <algorithm>

#include "fovea/drive/scans/lidar_scan.h"
#include "fovea/errors.h"

namespace fovea {
namespace {

/// Calls `read(file, stamp)` for scans that have a stamp until it returns true. Passes over scans
/// that cannot be read: load() reports the damage.
template <class Read>
void until(const NumberedFiles& scans, const StampOfScan& stamp, Read&& read) {
  for (const auto& [scan, file] : scans) {
    const std::optional<TimeNs> time = stamp(scan);
    if (!time) continue;
    try {
      if (read(file, *time)) return;
    } catch (const InputError&) {
      continue;
    }
  }
}

}  // namespace

std::vector<ScanNumbers> read_first_numbers(const NumberedFiles& scans, int count,
                                            const StampOfScan& stamp) {
  std::vector<ScanNumbers> numbers;
  until(scans, stamp, [&](const std::filesystem::path& file, TimeNs time) {
    numbers.push_back(read_scan_numbers(file, time));
    return numbers.size() >= static_cast<std::size_t>(count);
  });
  return numbers;
}

std::optional<double> sweep_middle(const PointCloud& scan) {
  if (scan.time.empty()) return std::nullopt;
  const auto [begin, end] = std::minmax_element(scan.time.begin(), scan.time.end());
  return 0.5 * (double(*begin) + double(*end));
}

std::optional<double> first_sweep_middle(const NumberedFiles& scans, const ScanFormat& format,
                                         const StampOfScan& stamp) {
  std::optional<double> middle;
  until(scans, stamp, [&](const std::filesystem::path& file, TimeNs time) {
    middle = sweep_middle(read_lidar_scan(file, format, time).points);
    return true;
  });
  return middle;
}

}  // namespace fovea
