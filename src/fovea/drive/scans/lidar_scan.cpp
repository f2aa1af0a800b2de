#include "fovea/drive/scans/lidar_scan.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "fovea/core/file_format.h"
#include "fovea/core/input_file.h"
#include "fovea/core/point_formats/pcd_rows.h"
#include "fovea/core/point_formats/ply_rows.h"
#include "fovea/drive/kitti/kitti_scan.h"
#include "fovea/drive/scans/scan_columns.h"
#include "fovea/errors.h"

namespace fovea {
namespace {

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

void ScanBuilder::count_dropped(const Eigen::Vector3f& position, float intensity, double time) {
  const float reach = position.cwiseAbs().maxCoeff<Eigen::PropagateNaN>();
  DroppedPoints& dropped = scan_.dropped;
  if (reach == 0 || (organized_ && position.array().isNaN().all())) {
    ++dropped.no_return;
  } else if (!std::isfinite(reach) || !std::isfinite(intensity) || !std::isfinite(time)) {
    ++dropped.not_finite;
  } else if (reach > kMaxCoordinate) {
    ++dropped.out_of_reach;
  } else {
    ++dropped.off_time;
  }
}

LidarScan ScanBuilder::take(const std::filesystem::path& file) {
  if (!scan_.points.empty()) return std::move(scan_);
  const DroppedPoints& dropped = scan_.dropped;
  std::string problem = "the scan has no usable point";
  if (dropped.total() > 0) problem += ": " + reasons_of(dropped);
  throw InputError(problem, file.string(), remedy_for(dropped));
}

std::span<const char* const> ScanRows::columns() const { return kScanColumns; }

const char* ScanRows::description() const { return kScanDescription; }

void ScanRows::begin(std::size_t points, std::span<const std::optional<Scalar>> types) {
  has_rings_ = types[kScanRing].has_value();
  has_times_ = format_.time_reference != TimeReference::kNone && types[kScanTime];
  if (has_times_) {
    time_unit_ = format_.time_unit.value_or(is_real(*types[kScanTime]) ? 1 : 1e-9);
  }
  scan_.emplace(points, has_times_);
  scan_->set_organized(organized_);
}

void ScanRows::add(std::span<const double> row, std::size_t /*number*/) {
  const Eigen::Vector3d position =
      format_.length_unit * Eigen::Vector3d(row[kScanX], row[kScanY], row[kScanZ]);
  const bool is_usable = scan_->add(position.cast<float>(),
                                    static_cast<float>(row[kScanIntensity] / format_.intensity_max),
                                    has_times_ ? seconds_from_stamp(row[kScanTime], position) : 0);
  if (is_usable && has_rings_) scan_->add_ring(row[kScanRing]);
}

LidarScan ScanRows::take(const std::filesystem::path& file) {
  LidarScan scan = scan_->take(file);
  if (has_times_ && format_.time_reference == TimeReference::kFirstPoint) {
    std::vector<float>& times = scan.points.time;
    const float first = *std::min_element(times.begin(), times.end());
    for (float& time : times) time -= first;
  }
  return scan;
}

double ScanRows::seconds_from_stamp(double time, const Eigen::Vector3d& position) {
  if (format_.time_reference == TimeReference::kStamp) return time * time_unit_;
  if (format_.time_reference == TimeReference::kFirstPoint) {
    const bool has_return = position.allFinite() && !position.isZero(0);
    if (!any_time_ && has_return && std::isfinite(time)) any_time_ = time;
    return (time - any_time_.value_or(time)) * time_unit_;
  }
  // Subtracted in the unit of the file: a double near 1.7e18 has a step of 256 ns.
  return (time - static_cast<double>(stamp_) * 1e-9 / time_unit_) * time_unit_;
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

namespace {

void read_scan_rows(InputFile& file, FileFormat format, CloudRows& rows) {
  if (format == FileFormat::kPcd) {
    read_pcd_rows(file, rows);
  } else if (format == FileFormat::kPly) {
    read_ply_rows(file, rows);
  } else {
    read_kitti_rows(file, rows);
  }
}

}  // namespace

LidarScan read_lidar_scan(const std::filesystem::path& file, const ScanFormat& format,
                          TimeNs stamp) {
  InputFile input(file, kScanFile);
  const FileFormat found = scan_format(input);
  if (found == FileFormat::kUnknown && format.length_unit == 1) {
    LidarScan scan = read_kitti_scan(input);
    const auto scale = static_cast<float>(format.intensity_max);
    for (float& intensity : scan.points.intensity) intensity /= scale;
    return scan;
  }
  ScanRows rows(format, stamp);
  read_scan_rows(input, found, rows);
  return rows.take(file);
}

ScanNumbers read_scan_numbers(const std::filesystem::path& file, TimeNs stamp) {
  ScanNumberRows rows(stamp);
  InputFile input(file, kScanFile);
  read_scan_rows(input, scan_format(input), rows);
  return rows.take();
}

}  // namespace fovea
