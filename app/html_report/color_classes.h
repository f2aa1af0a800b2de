// Errors in classes, which heat maps, tracks and their legends share; the page's CSS colours class
// k of either as .h0 (smallest) to .h5.
#pragma once

#include <array>
#include <cstddef>
#include <string>

namespace fovea::app {

inline constexpr std::size_t kErrorClasses = 6;

struct ErrorScale {
  std::string name, unit;
  std::array<double, kErrorClasses - 1> bounds;  ///< increasing; class k ends below bounds[k]

  std::size_t class_of(double value) const {
    std::size_t k = 0;
    while (k < bounds.size() && value >= bounds[k]) ++k;
    return k;
  }
};

/// TE, grey values; around 20 a difference is plain to see.
inline const ErrorScale kTeScale{"TE", "", {5, 10, 20, 40, 80}};
/// ME, cm.
inline const ErrorScale kMeScale{"ME", " cm", {1, 2, 5, 10, 20}};

/// A list of the classes with their bounds. @param share  of what is shown in each class, 0-1
std::string legend(const ErrorScale& scale, const std::array<double, kErrorClasses>& share);

}  // namespace fovea::app
