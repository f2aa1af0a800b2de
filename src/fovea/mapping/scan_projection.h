// A whole scan as a camera sees it, for questions about what lies around a pixel: which points are
// hidden, and which stand at an edge of depth. The map has no say in it.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "fovea/base/point_cloud.h"
#include "fovea/geometry/camera.h"

namespace fovea {

class ScanProjection {
 public:
  /// A point this much nearer to the camera hides what lies behind it: the larger of the two.
  static constexpr double kHidingStep = 0.3;    ///< m
  static constexpr double kHidingShare = 0.05;  ///< of the nearer point's distance
  /// ... within this many degrees of its ray. Rings of common LiDARs stand 1/3 to 1/2 degree apart:
  /// half of that reaches every gap between two rings of what hides, and stays on a ring of the
  /// ground, whose next ring is nearer too and hides nothing.
  static constexpr double kHidingDegrees = 0.25;

  /// Distances (from the camera) of two points at an edge of depth differ by more than this: the
  /// larger of the two. The ground at 15 m falls off by 5% from ring to ring, so 5% would find
  /// edges in it.
  static constexpr double kEdgeStep = 0.5;    ///< m
  static constexpr double kEdgeShare = 0.10;  ///< of the nearer one's
  static constexpr double kEdgePixels = 5;    ///< and their projections by less than this

  /// @param scan_lidar  the whole scan, motion compensated: points at any range hide
  ScanProjection(const PointCloud& scan_lidar, const Camera& camera);

  /// Whether the camera cannot see this point of the scan, because another point hides it: LiDAR
  /// and camera stand apart. @param pixel, distance  of the point (distance from the camera, m)
  bool hidden(const Eigen::Vector2d& pixel, double distance) const;

  /// Whether it stands at an edge of depth, on either side of it.
  bool near_edge(const Eigen::Vector2d& pixel, double distance) const;

 private:
  struct Point {
    float u, v, distance;
  };
  /// Whether `test(distance)` holds for any point within `radius` pixels.
  template <class Test>
  bool any_within(const Eigen::Vector2d& pixel, double radius, Test&& test) const;
  int column_of(double u) const;
  int row_of(double v) const;

  int columns_, rows_;
  double hiding_radius_;              // pixels
  std::vector<std::uint32_t> first_;  // of each cell in points_
  std::vector<Point> points_;
};

}  // namespace fovea
