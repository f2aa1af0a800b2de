// One LiDAR scan of any file format.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <limits>
#include <optional>
#include <span>

#include "fovea/base/file_format.h"
#include "fovea/base/input_file.h"
#include "fovea/base/point_cloud.h"
#include "fovea/base/time.h"
#include "fovea/sensor/cloud_rows.h"

namespace fovea {

struct LidarScan {
  PointCloud points;  ///< lidar frame, m; with intensity (0-1) and, where the file has them, times
  /// Points that were not finite, had a coordinate beyond 1 km or a time over a second off the
  /// stamp.
  std::size_t dropped = 0;
};

/// Gathers the usable points of a scan.
class ScanBuilder {
 public:
  /// @param points  as many at most
  /// @param timed   whether they have times
  ScanBuilder(std::size_t points, bool timed);

  /// A point without time: x, y, z (m) and intensity.
  using Row = std::array<float, 4>;

  /// @param time  s from the scan's stamp
  /// @return whether the point is usable
  bool add(const Eigen::Vector3f& position, float intensity, double time = 0) {
    if (!is_usable(position, intensity, time)) {
      ++scan_.dropped;
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

  LidarScan scan_;
  bool timed_;
};

/// What the time of a point counts from.
enum class TimeReference {
  kStamp,     ///< the scan's stamp
  kAbsolute,  ///< the epoch of the stamps
  kNone,      ///< nothing: points have no times, whatever their columns are called
};

/// What a scan's file does not say about its numbers.
struct ScanFormat {
  double intensity_max = 1;  ///< the value that stands for a reflectance of 1
  TimeReference time_reference = TimeReference::kStamp;
  /// s, of the points' times; absent: nanoseconds where they are whole numbers, or else seconds.
  std::optional<double> time_unit;
};

/// Columns of points' times; the first that is there counts.
inline constexpr std::array<const char*, 4> kPointTimeNames = {"t", "time", "timestamp",
                                                               "offset_time"};

/// Makes a scan of rows: x y z, perhaps intensity, ring (or channel) and one of kPointTimeNames.
class ScanRows : public CloudRows {
 public:
  /// @param stamp  of the scan
  ScanRows(const ScanFormat& format, TimeNs stamp) : format_(format), stamp_(stamp) {}

  std::span<const char* const> columns() const override;
  const char* description() const override { return "x y z, intensity, ring and time"; }
  void begin(std::size_t points, std::span<const std::optional<Scalar>> types) override;
  void add(std::span<const double> row, std::size_t number) override;

  /// As ScanBuilder::take.
  LidarScan take(const std::filesystem::path& file) { return scan_->take(file); }

 private:
  double seconds_from_stamp(double time) const;

  ScanFormat format_;
  TimeNs stamp_;
  std::optional<std::size_t> time_, ring_;  // columns
  double unit_ = 1;                         // s
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

}  // namespace fovea
