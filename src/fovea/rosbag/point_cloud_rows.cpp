#include "fovea/rosbag/point_cloud_rows.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "fovea/base/errors.h"

namespace fovea {
namespace {

using ros::PointCloud2;
using ros::PointField;

std::optional<Scalar> scalar_of(std::uint8_t datatype) {
  constexpr std::array<Scalar, 8> kTypes = {Scalar::kInt8,   Scalar::kUint8, Scalar::kInt16,
                                            Scalar::kUint16, Scalar::kInt32, Scalar::kUint32,
                                            Scalar::kFloat,  Scalar::kDouble};
  if (datatype < 1 || datatype > kTypes.size()) return std::nullopt;
  return kTypes[datatype - 1u];
}

/// A column in the cloud's data.
struct Column {
  Scalar type;
  std::size_t offset;
};

class Cloud {
 public:
  Cloud(const PointCloud2& cloud, const std::string& where) : cloud_(cloud), where_(where) {
    if (cloud.big_endian) refuse("its numbers are big endian");
    if (cloud.width == 0 || cloud.height == 0) refuse("it has no points");
    if (cloud.point_step == 0) refuse("its points have no bytes");
    const std::uint64_t row = std::uint64_t{cloud.width} * cloud.point_step;
    row_step_ = std::max<std::uint64_t>(row, cloud.row_step);  // which some drivers leave at 0
    // Divided, for the product may be beyond 64 bits.
    const bool fits =
        row <= cloud.data.size() && cloud.height - 1 <= (cloud.data.size() - row) / row_step_;
    if (!fits) refuse("it has fewer bytes than its points take");
  }

  std::optional<Column> find(std::string_view name) const {
    for (const PointField& field : cloud_.fields) {
      if (field.name != name) continue;
      const auto type = scalar_of(field.datatype);
      if (!type || std::uint64_t{field.offset} + size_of(*type) > cloud_.point_step) {
        refuse("a field lies outside of its points");
      }
      return Column{*type, field.offset};
    }
    return std::nullopt;
  }

  std::size_t size() const { return std::size_t{cloud_.width} * cloud_.height; }
  const char* point(std::size_t number) const {
    return cloud_.data.data() + number / cloud_.width * row_step_ +
           number % cloud_.width * cloud_.point_step;
  }
  static double value(const char* point, const Column& column) {
    return decode(column.type, point + column.offset);
  }

  [[noreturn]] void refuse(const char* why) const {
    throw InputError(std::string("the point cloud cannot be read: ") + why, where_,
                     "see docs/drives.md for what is read");
  }

 private:
  const PointCloud2& cloud_;
  const std::string& where_;
  std::uint64_t row_step_ = 0;  // bytes
};

std::optional<Column> find_column(const Cloud& cloud, std::string_view name) {
  auto column = cloud.find(name);
  if (!column && name == "intensity") column = cloud.find("reflectivity");
  return column;
}

}  // namespace

void read_cloud_rows(const PointCloud2& message, const std::string& where, CloudRows& rows) {
  const Cloud cloud(message, where);
  std::vector<std::optional<Column>> columns;
  std::vector<std::optional<Scalar>> types;
  for (const char* name : rows.columns()) {
    columns.push_back(find_column(cloud, name));
    types.push_back(columns.back() ? std::optional(columns.back()->type) : std::nullopt);
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (!types[axis] || !is_real(*types[axis])) cloud.refuse("it has no real x y z");
  }
  rows.begin(cloud.size(), types);
  std::vector<double> row(columns.size(), 0);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const char* point = cloud.point(i);
    for (std::size_t k = 0; k < columns.size(); ++k) {
      if (columns[k]) row[k] = Cloud::value(point, *columns[k]);
    }
    rows.add(row, i);
  }
}

ScanFormat time_format_of(const PointCloud2& message, const std::string& where) {
  constexpr double kShortest = 0.005, kLongest = 1;  // s, from first to last point
  const Cloud cloud(message, where);
  ScanFormat format;
  std::optional<Column> column;
  for (const char* name : kPointTimeNames) {
    if ((column = cloud.find(name))) break;
  }
  format.time_reference = TimeReference::kNone;
  if (!column) return format;
  const std::optional<Column> x_column = cloud.find("x");
  double first = std::numeric_limits<double>::infinity(), last = -first;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const double time = Cloud::value(cloud.point(i), *column);
    // Where nothing came back, times may be anything.
    const double x = x_column ? Cloud::value(cloud.point(i), *x_column) : 1;
    if (!std::isfinite(time) || !std::isfinite(x) || x == 0) continue;
    first = std::min(first, time), last = std::max(last, time);
  }
  const double stamp = seconds(message.header.stamp);
  for (const double unit : {1.0, 1e-3, 1e-6, 1e-9}) {
    const double duration = (last - first) * unit;
    if (!(duration >= kShortest && duration <= kLongest)) continue;
    for (const TimeReference reference : {TimeReference::kStamp, TimeReference::kAbsolute}) {
      const double offset = first * unit - (reference == TimeReference::kAbsolute ? stamp : 0);
      if (std::abs(offset) > kLongest) continue;
      format.time_unit = unit;
      format.time_reference = reference;
      return format;
    }
  }
  return format;
}

}  // namespace fovea
