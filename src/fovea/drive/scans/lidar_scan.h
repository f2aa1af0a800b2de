// One LiDAR scan of any file format.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <limits>
#include <optional>
#include <span>

#include "fovea/core/file_format.h"
#include "fovea/core/input_file.h"
#include "fovea/core/point_formats/cloud_rows.h"
#include "fovea/drive/scans/dropped_points.h"
#include "fovea/drive/scans/scan_format.h"
#include "fovea/drive/scans/scan_numbers.h"
#include "fovea/point_cloud.h"
#include "fovea/time.h"

namespace fovea {

struct LidarScan {
  PointCloud points;  ///< lidar frame, m; with intensity (0-1) and, where the file has them, times
  DroppedPoints dropped;
};

/// Gathers the usable points of a scan.
class ScanBuilder {
 public:
  /// @param points  as many at most
  /// @param timed   whether they have times
  ScanBuilder(std::size_t points, bool timed);

  /// NaN then marks a missing return.
  void set_organized(bool organized) { organized_ = organized; }

  /// A point without time: x, y, z (m) and intensity.
  using Row = std::array<float, 4>;

  /// @param time  s from the scan's stamp
  /// @return whether the point is usable
  bool add(const Eigen::Vector3f& position, float intensity, double time = 0) {
    if (!is_usable(position, intensity, time)) {
      count_dropped(position, intensity, time);
      return false;
    }
    scan_.points.position.push_back(position);
    scan_.points.intensity.push_back(intensity);
    if (timed_) scan_.points.time.push_back(static_cast<float>(time));
    return true;
  }

  /// The ring of the point just added: of every usable point, or of none.
  void add_ring(double number);

  /// Many at once, of a scan that has no times.
  void add(std::span<const Row> rows);

  /// InputError if none of the points was usable.
  LidarScan take(const std::filesystem::path& file);

 private:
  static constexpr float kMaxCoordinate = 1000;  // m; no LiDAR reaches it
  static constexpr double kMaxOffset = 1;        // s; no sweep lasts as long
  static bool is_usable(const Eigen::Vector3f& position, float intensity, double time) {
    // Written so that NaN fails, too, and without a branch. Zeros are what drivers write where
    // nothing came back.
    const float x = std::abs(position.x()), y = std::abs(position.y()), z = std::abs(position.z());
    return ((x <= kMaxCoordinate) & (y <= kMaxCoordinate) & (z <= kMaxCoordinate) &
            (x + y + z > 0) & (std::abs(intensity) <= std::numeric_limits<float>::max()) &
            (std::abs(time) <= kMaxOffset)) != 0;
  }

  void count_dropped(const Eigen::Vector3f& position, float intensity, double time);

  LidarScan scan_;
  bool timed_, organized_ = false;
};

/// Makes a scan of rows.
class ScanRows : public CloudRows {
 public:
  /// @param stamp  of the scan
  ScanRows(const ScanFormat& format, TimeNs stamp) : format_(format), stamp_(stamp) {}

  std::span<const char* const> columns() const override;
  bool takes_whole_coordinates() const override { return true; }
  const char* description() const override;
  void describe(std::span<const std::string> /*names*/, bool organized) override {
    organized_ = organized;
  }
  void begin(std::size_t points, std::span<const std::optional<Scalar>> types) override;
  void add(std::span<const double> row, std::size_t number) override;

  /// As ScanBuilder::take.
  LidarScan take(const std::filesystem::path& file);

 private:
  /// From any point, for TimeReference::kFirstPoint.
  double seconds_from_stamp(double time, const Eigen::Vector3d& position);

  ScanFormat format_;
  TimeNs stamp_;
  bool organized_ = false, has_times_ = false, has_rings_ = false;
  double time_unit_ = 1;            // s
  std::optional<double> any_time_;  // of a point
  std::optional<ScanBuilder> scan_;
};

/// Format of a scan by its content: PCD, PLY, or unknown for values without a header. InputError
/// that names the format of any other file.
FileFormat scan_format(const InputFile& file);

/// Reads a scan of any name: PCD (ascii, binary, binary_compressed) or PLY (ascii, binary little
/// endian) with the fields that ScanRows knows, or values without a header as read_kitti_scan. The
/// content decides which. InputError if the file has another format, is damaged or has no usable
/// point.
/// @param stamp  of the scan
LidarScan read_lidar_scan(const std::filesystem::path& file, const ScanFormat& format,
                          TimeNs stamp);

/// The numbers of the same files, as they are. InputError as above.
ScanNumbers read_scan_numbers(const std::filesystem::path& file, TimeNs stamp);

}  // namespace fovea
