// Passes points on whose columns are known, of messages that are no PointCloud2.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "fovea/core/point_formats/cloud_rows.h"
#include "fovea/core/point_formats/column_names.h"

namespace fovea {

struct NamedColumn {
  std::string name;
  Scalar type;
};

/// Brings the values of each point into the order that the receiver requests.
class NamedRows {
 public:
  /// @param points  as many at most
  NamedRows(std::span<const NamedColumn> columns, std::size_t points, CloudRows& rows)
      : rows_(rows) {
    std::vector<std::string> names;
    for (const NamedColumn& column : columns) names.push_back(column.name);
    std::vector<std::optional<Scalar>> types;
    for (const char* wanted : rows.columns()) {
      const auto found = find_column(names, wanted);
      places_.push_back(found);
      types.push_back(found ? std::optional(columns[*found].type) : std::nullopt);
    }
    row_.resize(places_.size());
    rows.describe(names, /*organized=*/false);
    rows.begin(points, types);
  }

  /// @param values  of a point, by column
  void add(std::span<const double> values) {
    for (std::size_t k = 0; k < places_.size(); ++k) {
      if (places_[k]) row_[k] = values[*places_[k]];
    }
    rows_.add(row_, number_++);
  }

 private:
  CloudRows& rows_;
  std::vector<std::optional<std::size_t>> places_;  // in `values`
  std::vector<double> row_;
  std::size_t number_ = 0;
};

}  // namespace fovea
