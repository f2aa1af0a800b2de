// The median of some numbers.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace fovea {

/// Of an even count, the larger one of the middle two; 0 of nothing.
template <class Number>
Number median_of(std::vector<Number> values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace fovea
