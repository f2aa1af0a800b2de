// Conditions on what a map knows of its points: "views >= 2 and range < 10".
#pragma once

#include <Eigen/Core>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "fovea/point_cloud.h"

namespace fovea {

/// Where a point of a map lies. NaN: unknown.
struct PointPlace {
  Eigen::Vector3d p_local =
      Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());  ///< m
  double height = std::numeric_limits<double>::quiet_NaN();  ///< m above the road (RoadHeight)
};

/// Conditions that hold together. Fields: x, y, z (m, in the frame `local`), height (m above the
/// road), views, spread (gray values), range (m), incidence (degrees), frame, camera (-1:
/// uncolored), rule (a number or name of PointRule), matched (exposure, 0 or 1), interpolated (0 or
/// 1), intensity (0-1). Operators: < <= > >= == (or =) !=. A value that a point does not have (an
/// unknown incidence, an intensity in a map without) meets no condition. MapPointFilter applies
/// them to the points of a map.
class PointFilter {
 public:
  PointFilter() = default;  ///< every point passes

  /// Conditions joined by "and". ConfigError that says what is not understood.
  static PointFilter parse(std::string_view text);

  bool empty() const { return conditions_.empty(); }

  /// Whether a condition is on x, y, z or height.
  bool needs_place() const;
  bool needs_height() const;

  /// @param tile   with the columns of a map's tile
  /// @param place  of the point; what is not needed may be unknown
  bool matches(const PointCloud& tile, std::size_t index, const PointPlace& place) const;

 private:
  enum class Operator { kLess, kLessEqual, kGreater, kGreaterEqual, kEqual, kNotEqual };
  enum class Needs { kColumns, kPosition, kHeight };
  struct Field {
    std::string_view name;
    double (*value)(const PointCloud& tile, std::size_t index, const PointPlace& place);
    Needs needs = Needs::kColumns;
  };
  struct Condition {
    const Field* field;
    Operator op;
    double number;
    bool holds(double value) const;
  };
  static const Field* find_field(std::string_view name);
  static Condition parse_condition(const std::string& text);
  std::vector<Condition> conditions_;
};

}  // namespace fovea
