// The line that a street follows and the vehicle drives along.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "fovea/platform.h"

namespace fovea {

/// A plane curve by its heading, a smooth function of the way along it (m). Position is the
/// integral of the direction, to 1e-9 m where the heading is smooth over half a metre; any `s` of
/// the range asked for, in any order, from any thread.
class Path {
 public:
  struct Point {
    Eigen::Vector2d position;  ///< world, m
    double heading = 0;        ///< rad, counter-clockwise from world x
    double curvature = 0;      ///< 1/m, heading's derivative
  };

  /// @param heading    rad at s
  /// @param curvature  its derivative, 1/m
  /// @param begin,end  range of s in which at() is exact; s = 0 lies in it (std::invalid_argument
  ///                   otherwise)
  /// @param start      position at s = 0 (world, m)
  Path(std::function<double(double)> heading, std::function<double(double)> curvature, double begin,
       double end, const Eigen::Vector2d& start = Eigen::Vector2d::Zero());

  /// std::out_of_range for an `s` beyond the range: nothing is known there.
  Point at(double s) const;
  double begin() const { return begin_; }
  double end() const { return end_; }

  /// Place at (s along, d to the left) in the plane.
  Eigen::Vector2d offset(double s, double d) const;

 private:
  /// Integral of the direction from `from` to `to`, at most kStep apart.
  Eigen::Vector2d way_between(double from, double to) const;

  static constexpr double kStep = 0.5;  // m

  std::function<double(double)> heading_, curvature_;
  double begin_, end_;
  std::vector<Eigen::Vector2d> knots_;  // positions every kStep from begin_
};

}  // namespace fovea
