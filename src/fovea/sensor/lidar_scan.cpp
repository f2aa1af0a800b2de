#include "fovea/sensor/lidar_scan.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "fovea/base/errors.h"
#include "fovea/base/file_format.h"
#include "fovea/base/input_file.h"
#include "fovea/sensor/kitti_scan.h"
#include "fovea/sensor/pcd_rows.h"
#include "fovea/sensor/ply_rows.h"

namespace fovea {
namespace {

enum Column : std::size_t { kX, kY, kZ, kIntensity, kRing, kChannel, kFirstTime };
constexpr auto kColumns = [] {
  std::array<const char*, kFirstTime + kPointTimeNames.size()> names = {
      "x", "y", "z", "intensity", "ring", "channel"};
  std::copy(kPointTimeNames.begin(), kPointTimeNames.end(), names.begin() + kFirstTime);
  return names;
}();

bool has_ending(const std::filesystem::path& file, std::string_view lower_case) {
  std::string ending = file.extension().string();
  for (char& c : ending) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return ending == lower_case;
}

}  // namespace

ScanBuilder::ScanBuilder(std::size_t points, bool timed) : timed_(timed) {
  scan_.points.position.reserve(points);
  scan_.points.intensity.reserve(points);
  if (timed_) scan_.points.time.reserve(points);
}

void ScanBuilder::add(std::span<const Row> rows) {
  const auto position = [](const Row& row) { return Eigen::Vector3f(row[0], row[1], row[2]); };
  int usable = 1;
  for (const Row& row : rows) usable &= int{is_usable(position(row), row[3], 0)};
  if (usable == 0) {
    for (const Row& row : rows) add(position(row), row[3]);
    return;
  }
  // Nearly always.
  const std::size_t before = scan_.points.size();
  scan_.points.position.resize(before + rows.size());
  scan_.points.intensity.resize(before + rows.size());
  Eigen::Vector3f* const to = &scan_.points.position[before];
  float* const intensity = &scan_.points.intensity[before];
  for (std::size_t i = 0; i < rows.size(); ++i) {
    to[i] = position(rows[i]);
    intensity[i] = rows[i][3];
  }
}

void ScanBuilder::add_ring(double number) {
  // Written so that NaN fails, too.
  const bool is_ring = number >= 0 && number <= std::numeric_limits<std::uint16_t>::max();
  scan_.points.ring.push_back(is_ring ? static_cast<std::uint16_t>(number) : 0);
}

LidarScan ScanBuilder::take(const std::filesystem::path& file) {
  if (!scan_.points.empty()) return std::move(scan_);
  throw InputError("the scan has no usable point (" + std::to_string(scan_.dropped) +
                       " are not finite, beyond 1 km or over 1 s off the stamp)",
                   file.string(), "restore the file from the drive's archive");
}

std::span<const char* const> ScanRows::columns() const { return kColumns; }

void ScanRows::begin(std::size_t points, std::span<const std::optional<Scalar>> types) {
  if (format_.time_reference != TimeReference::kNone) {
    for (std::size_t column = types.size(); column-- > kFirstTime;) {
      if (types[column]) time_ = column;
    }
  }
  if (time_) unit_ = format_.time_unit.value_or(is_real(*types[*time_]) ? 1 : 1e-9);
  for (const Column column : {kChannel, kRing}) {
    if (types[column]) ring_ = column;
  }
  scan_.emplace(points, time_.has_value());
}

void ScanRows::add(std::span<const double> row, std::size_t) {
  const Eigen::Vector3d position(row[kX], row[kY], row[kZ]);
  const bool is_usable = scan_->add(position.cast<float>(),
                                    static_cast<float>(row[kIntensity] / format_.intensity_max),
                                    time_ ? seconds_from_stamp(row[*time_]) : 0);
  if (is_usable && ring_) scan_->add_ring(row[*ring_]);
}

double ScanRows::seconds_from_stamp(double time) const {
  if (format_.time_reference == TimeReference::kStamp) return time * unit_;
  // Nanoseconds since 1970 take 61 bits: of numbers as large, doubles have but every 256th.
  return (time - static_cast<double>(stamp_) * 1e-9 / unit_) * unit_;
}

FileFormat scan_format(const InputFile& file) {
  const SniffedFormat found = sniff_format(file.beginning(kSniffedBytes));
  switch (found.format) {
    case FileFormat::kPcd:
    case FileFormat::kPly:
      return found.format;
    case FileFormat::kUnknown:
      // Their readers report the line in which a damaged header is wrong.
      if (has_ending(file.path(), ".pcd")) return FileFormat::kPcd;
      if (has_ending(file.path(), ".ply")) return FileFormat::kPly;
      return FileFormat::kUnknown;
    default:
      throw InputError("this is " + std::string(found.name) + ", no scan", file.path().string(),
                       "convert it to PCD, PLY or .bin (docs/drives.md)");
  }
}

LidarScan read_lidar_scan(const std::filesystem::path& file, const ScanFormat& format,
                          TimeNs stamp) {
  InputFile input(file, kScanFile);
  const FileFormat found = scan_format(input);
  if (found == FileFormat::kUnknown) {
    LidarScan scan = read_kitti_scan(input);
    const auto scale = static_cast<float>(format.intensity_max);
    for (float& intensity : scan.points.intensity) intensity /= scale;
    return scan;
  }
  ScanRows rows(format, stamp);
  if (found == FileFormat::kPcd) {
    read_pcd_rows(input, rows);
  } else {
    read_ply_rows(input, rows);
  }
  return rows.take(file);
}

}  // namespace fovea
