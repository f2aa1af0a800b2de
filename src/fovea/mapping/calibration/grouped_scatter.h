// Scatter of sums whose terms have common errors.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <map>
#include <vector>

#include "fovea/platform.h"

namespace fovea {

/// Covariance of the sum of the items' vectors, of mean zero. Items of one group have common
/// errors, those of two groups have none. Corrected for the number of groups.
/// @param vector_of  an Eigen column vector of an item, of fixed size
/// @param group_of   the group of an item: ordered by <
template <class Item, class VectorOf, class GroupOf>
auto grouped_scatter(const std::vector<Item>& items, VectorOf&& vector_of, GroupOf&& group_of) {
  using Vector = std::decay_t<decltype(vector_of(items.front()))>;
  using Matrix = Eigen::Matrix<double, Vector::RowsAtCompileTime, Vector::RowsAtCompileTime>;
  std::map<std::decay_t<decltype(group_of(items.front()))>, Vector> sums;
  for (const Item& item : items) {
    sums.try_emplace(group_of(item), Vector::Zero()).first->second += vector_of(item);
  }
  Matrix scatter = Matrix::Zero();
  for (const auto& [group, sum] : sums) scatter += sum * sum.transpose();
  const double groups = static_cast<double>(sums.size());
  return Matrix(groups / std::max(groups - 1, 1.0) * scatter);
}

}  // namespace fovea
