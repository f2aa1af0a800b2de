// Conditions on what a map knows of its points: "views >= 2 and range < 10".
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "fovea/point_cloud.h"

namespace fovea {

/// Conditions that hold together. Fields: views, spread (grey values), range (m), incidence
/// (degrees), frame, camera (-1: uncoloured), rule (a number or name of PointRule), matched
/// (exposure, 0 or 1), interpolated (0 or 1), intensity (0-1). Operators: < <= > >= == (or =) !=. A
/// value that a point does not have (an unknown incidence, an intensity in
/// a map without) meets no condition.
class PointFilter {
 public:
  PointFilter() = default;  ///< every point passes

  /// Conditions joined by "and". ConfigError that says what is not understood.
  static PointFilter parse(std::string_view text);

  bool empty() const { return conditions_.empty(); }

  /// @param tile  with the columns of a map's tile
  bool matches(const PointCloud& tile, std::size_t index) const;

 private:
  enum class Operator { kLess, kLessEqual, kGreater, kGreaterEqual, kEqual, kNotEqual };
  struct Condition {
    double (*value)(const PointCloud& tile, std::size_t index);
    Operator op;
    double number;
    bool holds(double value) const;
  };
  static Condition parse_condition(const std::string& text);
  std::vector<Condition> conditions_;
};

}  // namespace fovea
