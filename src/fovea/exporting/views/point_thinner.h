// A map's points, thinned to as many as a trainer begins with.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "fovea/core/flat_map.h"
#include "fovea/image.h"

namespace fovea {

/// Keeps the first point of each cell of a grid. If the cells have more points than allowed, they
/// grow until they fit: by a quarter of their edge, so that over half of the points stay.
///
///   PointThinner thinner(0.05, 500'000);
///   for (const ExportPoint& point : ...) thinner.add({point.position, point.color});
///   use(thinner.points());
class PointThinner {
 public:
  struct Point {
    Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< m
    Rgb color;
  };

  /// @param cell        edge of a cell, m
  /// @param max_points  at least 8: eight cells meet at the origin, however large they are
  PointThinner(double cell, std::size_t max_points)
      : cell_(cell), max_points_(std::max<std::size_t>(max_points, 8)) {}

  void add(const Point& point);

  const std::vector<Point>& points() const { return points_; }
  double cell() const { return cell_; }

 private:
  std::uint64_t key_of(const Eigen::Vector3d& position) const;
  void grow_cells();

  double cell_;
  std::size_t max_points_;
  FlatMap<std::uint8_t> taken_;
  std::vector<Point> points_;
};

}  // namespace fovea
