// Light: the exposure of an image relative to that of the map (docs/method.md 6).
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <vector>

#include "fovea/core/view_light.h"
#include "fovea/platform.h"

namespace fovea {

/// Gray values from here on are saturated; values up to kDarkValue are noise.
inline constexpr float kSaturatedValue = 248, kDarkValue = 6;

/// Stops between the limits of values and the mean of two values that are compared.
inline constexpr float kExposureMargin = 0.4f;

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
/// The same of the points whose mean of image and map is far from dark and from saturated: a limit
/// for the image alone would favor points whose noise goes one way.
/// @param map     codes of the points in the map
/// @param offset  of the camera's response, in the exposure codes of which both are
std::optional<LogGain> gain_of(const CodeDifferences& image_minus_map, const CodeDifferences& map,
                               double offset);

/// Mean absolute difference that a gain leaves, percent.
double residual_percent(const CodeDifferences& image_minus_map, const LogGain& gain);

/// The most frequent of some values.
struct Mode {
  float value = 0;
  float reach = 0;  ///< values farther off do not count
};
/// The center of the fullest window, refined by Tukey's biweight. Its reach is three times the
/// median absolute deviation: hidden points and depth edges make one tail of the differences long.
/// @param values  at least one
/// @param window  width of the window; the reach is one to eight times this
Mode mode_of(const std::vector<float>& values, float window);
/// Tukey's biweight of a value, 0 to 1.
double biweight(double value, const Mode& mode);

}  // namespace fovea
