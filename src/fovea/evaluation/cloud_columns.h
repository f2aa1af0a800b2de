// What the readers of other programs' clouds have in common: the columns they fill and the checks
// of their values.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>

#include "fovea/base/point_cloud.h"

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

/// Types of binary numbers in a file.
enum class Scalar {
  kInt8,
  kUint8,
  kInt16,
  kUint16,
  kInt32,
  kUint32,
  kInt64,
  kUint64,
  kFloat,
  kDouble
};
std::size_t size_of(Scalar type);
/// The number at `bytes`, little endian.
double decode(Scalar type, const char* bytes);

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

/// Lines of a file that may be anything: none is longer than 64 KiB.
class LineReader {
 public:
  /// InputError if the file cannot be read.
  explicit LineReader(const std::filesystem::path& file);

  /// The next line without its end (LF or CRLF); empty at the end of the file. InputError for a
  /// line that is too long.
  std::optional<std::string> next();
  int line_number() const { return line_number_; }  ///< of the last line, from 1
  std::ifstream& stream() { return stream_; }       ///< after the last line
  /// Bytes after the last line.
  std::uintmax_t rest();

 private:
  std::string name_;
  std::ifstream stream_;
  std::uintmax_t size_ = 0;
  int line_number_ = 0;
  std::string buffer_;
};

}  // namespace fovea
