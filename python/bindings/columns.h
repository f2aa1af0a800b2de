// Columns of a point cloud as arrays over their memory.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "fovea/point_cloud.h"
#include "python/bindings/arrays.h"

namespace fovea::python {

template <class Entry>
struct ColumnEntry {
  using Scalar = Entry;
  static constexpr int kWidth = 1;
};
template <>
struct ColumnEntry<Eigen::Vector3f> {
  using Scalar = float;
  static constexpr int kWidth = 3;
};

/// N or N x 3 numbers.
template <class Entry>
pybind11::array column_array(const std::shared_ptr<const PointCloud>& cloud,
                             std::vector<Entry> PointCloud::* column) {
  using Scalar = typename ColumnEntry<Entry>::Scalar;
  constexpr int kWidth = ColumnEntry<Entry>::kWidth;
  static_assert(sizeof(Entry) == kWidth * sizeof(Scalar));
  const std::vector<Entry>& entries = (*cloud).*column;
  std::vector<pybind11::ssize_t> shape{static_cast<pybind11::ssize_t>(entries.size())};
  if (kWidth > 1) shape.push_back(kWidth);
  return shared_array(pybind11::dtype::of<Scalar>(), std::move(shape), entries.data(), cloud);
}

/// Nothing where the cloud has points, and not this column.
template <class Entry>
std::optional<pybind11::array> optional_column(const std::shared_ptr<const PointCloud>& cloud,
                                               std::vector<Entry> PointCloud::* column) {
  if (((*cloud).*column).size() != cloud->size()) return std::nullopt;
  return column_array(cloud, column);
}

}  // namespace fovea::python
