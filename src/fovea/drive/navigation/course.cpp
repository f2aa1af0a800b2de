#include "fovea/drive/navigation/course.h"

#include <algorithm>
#include <cmath>

namespace fovea {

std::optional<std::vector<double>> course_headings(const std::vector<TimeNs>& times,
                                                   const std::vector<Eigen::Vector3d>& positions,
                                                   std::optional<double> before) {
  constexpr double kFar = 1;                     // m
  constexpr TimeNs kLongest = 2 * kNsPerSecond;  // from the first to the last place of a way
  const std::size_t count = positions.size();
  std::vector<std::optional<double>> headings(count);
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t step = 1; step < count; ++step) {
      const std::size_t first = i - std::min(i, step), last = std::min(i + step, count - 1);
      if (times[last] - times[first] > kLongest) break;
      const Eigen::Vector2d way = (positions[last] - positions[first]).head<2>();
      if (way.norm() >= kFar) {
        headings[i] = std::atan2(way.y(), way.x());
        break;
      }
      if (first == 0 && last == count - 1) break;
    }
  }
  const auto known = [](const std::optional<double>& heading) { return heading.has_value(); };
  if (!before) {
    const auto first_known = std::find_if(headings.begin(), headings.end(), known);
    if (first_known == headings.end()) return std::nullopt;
    before = **first_known;
  }
  std::vector<double> result;
  result.reserve(count);
  for (const std::optional<double>& heading : headings) {
    result.push_back(heading.value_or(result.empty() ? *before : result.back()));
  }
  return result;
}

}  // namespace fovea
