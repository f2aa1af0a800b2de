// Numbers kept as whole steps.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

namespace fovea {

/// Whole number of steps nearest to a value, of those that `Number` holds up to `most`; 0 of NaN.
template <class Number, class Real>
Number steps(Real value, Real step, Number most = std::numeric_limits<Number>::max()) {
  // std::round would be a call; a step is known to the compiler, mostly, which divides once by it.
  // Choices in this order are one instruction each.
  const Real count = std::floor(value * (1 / step) + Real(0.5));
  return static_cast<Number>(
      static_cast<std::int32_t>(std::min(Real(most), std::max(Real(0), count))));
}

}  // namespace fovea
