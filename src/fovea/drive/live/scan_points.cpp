#include "fovea/drive/live/scan_points.h"

#include <fmt/format.h>

#include <array>
#include <vector>

#include "fovea/drive/scans/scan_columns.h"
#include "fovea/errors.h"

namespace fovea {
namespace {

void require_length(std::size_t length, std::size_t points, const char* column,
                    const std::string& name) {
  if (length == 0 || length == points) return;
  throw InputError(
      fmt::format("the scan has {} points and {} values of {}", points, length, column), name,
      "give a value for each point, or none");
}

}  // namespace

void read_points(const PointCloud& scan, const std::string& name, CloudRows& rows) {
  const std::size_t size = scan.size();
  require_length(scan.intensity.size(), size, "intensity", name);
  require_length(scan.time.size(), size, "time", name);
  require_length(scan.ring.size(), size, "ring", name);
  std::vector<std::string> names = {"x", "y", "z", "intensity"};
  std::array<std::optional<Scalar>, kScanColumns.size()> types{};
  for (const ScanColumn column : {kScanX, kScanY, kScanZ, kScanIntensity}) {
    types[column] = Scalar::kFloat;
  }
  if (!scan.time.empty()) {
    names.emplace_back("time");
    types[kScanTime] = Scalar::kFloat;
  }
  if (!scan.ring.empty()) {
    names.emplace_back("ring");
    types[kScanRing] = Scalar::kUint16;
  }
  rows.describe(names, /*organized=*/false);
  rows.begin(size, types);
  std::array<double, kScanColumns.size()> row{};
  for (std::size_t i = 0; i < size; ++i) {
    const Eigen::Vector3f& p = scan.position[i];
    row[kScanX] = double(p.x());
    row[kScanY] = double(p.y());
    row[kScanZ] = double(p.z());
    row[kScanIntensity] = scan.intensity.empty() ? 0 : double(scan.intensity[i]);
    row[kScanTime] = scan.time.empty() ? 0 : double(scan.time[i]);
    row[kScanRing] = scan.ring.empty() ? 0 : double(scan.ring[i]);
    rows.add(row, i);
  }
}

LidarScan usable_points(const PointCloud& scan, const ScanFormat& format, TimeNs stamp,
                        const std::string& name) {
  ScanRows rows(format, stamp);
  read_points(scan, name, rows);
  return rows.take(name);
}

ScanNumbers numbers_of(const PointCloud& scan, TimeNs stamp, const std::string& name) {
  ScanNumberRows rows(stamp);
  read_points(scan, name, rows);
  return rows.take();
}

}  // namespace fovea
