// Light: the exposure of an image relative to that of the map (docs/method.md 6).
#pragma once

#include <Eigen/Core>
#include <array>
#include <map>
#include <optional>
#include <vector>

#include "fovea/core/eigen_alignment.h"
#include "fovea/core/log_color.h"

namespace fovea {

/// Gray values from here on are saturated; values up to kDarkValue are noise.
inline constexpr float kSaturatedValue = 248, kDarkValue = 6;

/// Color codes of an image minus those of the map, at the same points.
struct CodeDifferences {
  std::array<std::vector<float>, 3> channel;

  std::size_t size() const { return channel[0].size(); }
  void add(const Eigen::Array3f& difference) {
    for (int c = 0; c < 3; ++c) channel[std::size_t(c)].push_back(difference[c]);
  }
  void append(const CodeDifferences& other);
};

/// The most frequent gain: the mode of the differences, since ratios at moving shadows and at
/// surfaces that moved are a second, smaller peak. Absent with fewer than 150 differences.
std::optional<LogGain> gain_of(const CodeDifferences& image_minus_map);

/// The gains of a drive's views, in the order of the views.
class ViewGains {
 public:
  /// The gain of the next view of a camera. A view that shows too little of the map has the gain
  /// of the camera's view before; the first view of a drive has the exposure of the map.
  LogGain next(int camera, const CodeDifferences& image_minus_map);
  /// Continues after the views of an earlier run.
  void resume(int camera, const LogGain& gain) { last_[camera] = gain; }

 private:
  std::map<int, LogGain> last_;  // by camera
};

/// Mean absolute difference that a gain leaves, percent.
double residual_percent(const CodeDifferences& image_minus_map, const LogGain& gain);

/// The most frequent value: the center of the fullest window of 12 codes, refined by Tukey's
/// biweight.
/// @param values  at least one
float mode_of(std::vector<float> values);

}  // namespace fovea
