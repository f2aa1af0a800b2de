#include "fovea/evaluation/distribution.h"

#include <algorithm>
#include <cmath>

namespace fovea {

Distribution distribution(std::vector<float> values) {
  if (values.empty()) return {};
  Distribution d;
  d.count = values.size();
  const auto n = static_cast<double>(d.count);
  double sum = 0, squares = 0;
  for (const double value : values) {
    sum += value;
    squares += value * value;
  }
  d.mean = sum / n;
  d.rmse = std::sqrt(squares / n);
  const auto at = [&](std::size_t rank) {
    const auto place = values.begin() + static_cast<std::ptrdiff_t>(rank);
    std::nth_element(values.begin(), place, values.end());
    return static_cast<double>(*place);
  };
  d.median = 0.5 * (at((d.count - 1) / 2) + at(d.count / 2));
  d.p95 = at((19 * d.count + 19) / 20 - 1);
  d.max = at(d.count - 1);
  return d;
}

double share_within(const std::vector<float>& values, float bound) {
  if (values.empty()) return Distribution::kNone;
  const auto within =
      std::count_if(values.begin(), values.end(), [&](float value) { return value <= bound; });
  return static_cast<double>(within) / static_cast<double>(values.size());
}

std::vector<std::size_t> histogram(const std::vector<float>& values, float width) {
  std::vector<std::size_t> counts;
  for (const float value : values) {
    if (!std::isfinite(value)) continue;
    const auto bin = static_cast<std::size_t>(value / width);
    if (bin >= counts.size()) counts.resize(bin + 1);
    ++counts[bin];
  }
  return counts;
}

}  // namespace fovea
