// A stable sort for values of any alignment.
#pragma once

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <utility>
#include <vector>

namespace fovea {

/// Sorts as std::stable_sort does. That of libstdc++ 12 moves values through memory that it does
/// not align, which crashes with Eigen's fixed-size types; this one sorts their numbers.
template <class T, class Less>
void sort_stably(std::vector<T>& values, const Less& less) {
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return less(values[a], values[b]); });
  std::vector<T> sorted;
  sorted.reserve(values.size());
  for (const std::size_t index : order) sorted.push_back(std::move(values[index]));
  values = std::move(sorted);
}

}  // namespace fovea
