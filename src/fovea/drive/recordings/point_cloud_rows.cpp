#include "fovea/drive/recordings/point_cloud_rows.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "fovea/core/point_formats/column_names.h"
#include "fovea/errors.h"

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
    if (cloud.width == 0 || cloud.height == 0) refuse("it has no points");
    if (cloud.point_step == 0) refuse("its points have no bytes");
    const std::uint64_t row = std::uint64_t{cloud.width} * cloud.point_step;
    row_step_ = std::max<std::uint64_t>(row, cloud.row_step);  // which some drivers leave at 0
    // Divided, for the product may be beyond 64 bits.
    const bool fits =
        row <= cloud.data.size() && cloud.height - 1 <= (cloud.data.size() - row) / row_step_;
    if (!fits) refuse("it has fewer bytes than its points take");
  }

  std::vector<std::string> names() const {
    std::vector<std::string> names;
    for (const PointField& field : cloud_.fields) names.emplace_back(field.name);
    return names;
  }
  Column column(std::size_t place) const {
    const PointField& field = cloud_.fields[place];
    const auto type = scalar_of(field.datatype);
    if (!type || std::uint64_t{field.offset} + size_of(*type) > cloud_.point_step) {
      refuse("a field lies outside of its points");
    }
    return Column{*type, field.offset};
  }

  std::size_t size() const { return std::size_t{cloud_.width} * cloud_.height; }
  const char* point(std::size_t number) const {
    return cloud_.data.data() + number / cloud_.width * row_step_ +
           number % cloud_.width * cloud_.point_step;
  }
  double value(const char* point, const Column& column) const {
    const char* bytes = point + column.offset;
    if (!cloud_.big_endian) return decode(column.type, bytes);
    std::array<char, sizeof(double)> swapped;
    std::reverse_copy(bytes, bytes + size_of(column.type), swapped.begin());
    return decode(column.type, swapped.data());
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

}  // namespace

void read_cloud_rows(const PointCloud2& message, const std::string& where, CloudRows& rows) {
  const Cloud cloud(message, where);
  std::vector<std::optional<Column>> columns;
  std::vector<std::optional<Scalar>> types;
  const std::vector<std::string> names = cloud.names();
  for (const char* wanted : rows.columns()) {
    columns.emplace_back();
    types.emplace_back();
    if (const auto found = find_column(names, wanted)) {
      columns.back() = cloud.column(*found);
      types.back() = columns.back()->type;
    }
  }
  if (!are_coordinates(types, rows)) cloud.refuse("it has no real x y z");
  rows.describe(names, message.height > 1);
  rows.begin(cloud.size(), types);
  std::vector<double> row(columns.size(), 0);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const char* point = cloud.point(i);
    for (std::size_t k = 0; k < columns.size(); ++k) {
      if (columns[k]) row[k] = cloud.value(point, *columns[k]);
    }
    rows.add(row, i);
  }
}

}  // namespace fovea
