// What the readers of other programs' clouds have in common: the columns they fill and the checks
// of their values.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <string>

#include "fovea/point_cloud.h"

namespace fovea {

/// A coloured cloud of any program.
struct CloudFile {
  /// Columns position, color and camera; frame and interpolated where the file has them. Points are
  /// uncoloured (kNoCamera) where the file says so or has no colours; camera is 0 where it names
  /// none.
  PointCloud points;
  bool has_camera = false;
};

/// The columns that are read, in the order in which a point's values are handed on.
enum CloudColumn : std::size_t {
  kX,
  kY,
  kZ,
  kRed,
  kGreen,
  kBlue,
  kCamera,
  kFrame,
  kInterpolated,
  kCloudColumns
};
using CloudRow = std::array<double, kCloudColumns>;  ///< metres of the file's frame; colours 0-255

/// White in colors of 16 bits.
inline constexpr double kDeepWhite = 65535;
/// Brings colors to 0-255, rounded.
inline void scale_colors(CloudRow& row, double white) {
  if (white == 255) return;
  for (const CloudColumn channel : {kRed, kGreen, kBlue}) {
    row[channel] = std::round(row[channel] * 255 / white);
  }
}

/// Gathers the points of a file, checking each.
class CloudBuilder {
 public:
  /// @param file    for errors
  /// @param origin  that the points are made relative to
  CloudBuilder(const std::filesystem::path& file, const Eigen::Vector3d& origin);

  /// Says which columns the rows have and how many rows to expect. InputError for more points than
  /// can be indexed. The caller has made sure that the file is long enough for them.
  void expect(std::size_t points, const std::array<bool, kCloudColumns>& columns);

  /// InputError that names the point if a value is not finite or out of its column's range, or the
  /// point lies over 50 km off the origin.
  /// @param number  of the point in the file, from 0
  void add(const CloudRow& row, std::size_t number);

  CloudFile take() { return std::move(cloud_); }

 private:
  std::string name_;
  std::array<bool, kCloudColumns> has_{};
  CloudFile cloud_;
};

}  // namespace fovea
