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

/// How many values lie in [0, width), [width, 2 width), ... up to the largest.
/// @param values  none below 0; what is not finite is left out
/// @param width   above 0
std::vector<std::size_t> histogram(const std::vector<float>& values, float width);

}  // namespace fovea
