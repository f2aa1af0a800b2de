// One LiDAR scan of any file format.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>

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

  /// @param time  s from the scan's stamp
  void add(const Eigen::Vector3f& position, float intensity, double time = 0);

  /// InputError if none of the points was usable.
  LidarScan take(const std::filesystem::path& file);

 private:
  LidarScan scan_;
  bool timed_;
};

/// What the time of a point counts from.
enum class TimeReference {
  kStamp,     ///< the scan's stamp
  kAbsolute,  ///< the epoch of the stamps
};

/// What a scan's file does not say about its numbers.
struct ScanFormat {
  double intensity_max = 1;  ///< the value that stands for a reflectance of 1
  TimeReference time_reference = TimeReference::kStamp;
  /// s, of the points' times; absent: nanoseconds where they are whole numbers, or else seconds.
  std::optional<double> time_unit;
};

/// Reads a scan: .bin as read_kitti_scan, .pcd (ascii, binary, binary_compressed) or .ply (ascii,
/// binary little endian) with the fields x y z, perhaps intensity, and perhaps one of t, time,
/// timestamp, offset_time, the first of which counts; other fields are passed over. InputError if
/// the file is damaged, of another ending, or has no usable point.
/// @param stamp  of the scan
LidarScan read_lidar_scan(const std::filesystem::path& file, const ScanFormat& format,
                          TimeNs stamp);

}  // namespace fovea
