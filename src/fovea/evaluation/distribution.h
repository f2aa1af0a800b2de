// Figures of a set of errors.
#pragma once

#include <cstddef>
#include <limits>
#include <vector>

namespace fovea {

/// NaN where there is no value.
struct Distribution {
  static constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  std::size_t count = 0;
  double mean = kNone, rmse = kNone, median = kNone;
  double p95 = kNone;  ///< the smallest value that 95 % of the values do not exceed
  double max = kNone;
};
Distribution distribution(std::vector<float> values);

/// Share of the values up to a bound (included); NaN if there is none.
double share_within(const std::vector<float>& values, float bound);

}  // namespace fovea
