// The line that a street follows and the vehicle drives along.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

namespace fovea {

/// A plane curve by its heading, a smooth function of the way along it (m). Position is the
/// integral of the direction, to 1e-9 m; any `s` of the range asked for, in any order, from any
/// thread.
class Path {
 public:
  struct Point {
    Eigen::Vector2d position;  ///< world, m
    double heading = 0;        ///< rad, counter-clockwise from world x
    double curvature = 0;      ///< 1/m, heading's derivative
  };

  /// @param heading    rad at s
  /// @param curvature  its derivative, 1/m
  /// @param begin,end  range of s in which at() is exact; s = 0 lies at the world's origin
  Path(std::function<double(double)> heading, std::function<double(double)> curvature, double begin,
       double end);

  Point at(double s) const;
  double begin() const { return begin_; }
  double end() const { return end_; }

  /// Place at (s along, d to the left) in the plane.
  Eigen::Vector2d offset(double s, double d) const;

 private:
  std::function<double(double)> heading_, curvature_;
  double begin_, end_;
  std::vector<Eigen::Vector2d> knots_;  // positions every kStep from begin_
};

}  // namespace fovea
