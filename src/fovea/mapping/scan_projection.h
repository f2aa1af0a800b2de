// A whole scan projected into a camera: finds points that other points hide, and points at an edge
// of depth. Does not use the map.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "fovea/camera.h"
#include "fovea/point_cloud.h"

namespace fovea {

class ScanProjection {
 public:
  /// A point hides others that are this much farther from the camera: the larger of the two.
  static constexpr double kHidingStep = 0.3;    ///< m
  static constexpr double kHidingShare = 0.05;  ///< of the nearer point's distance
  /// ... within this many degrees of its ray. Common LiDARs have rings 1/3 to 1/2 degree apart.
  /// Half of that closes every gap between two rings of an object. On the ground it does not reach
  /// the next ring, which is nearer and must hide nothing.
  static constexpr double kHidingDegrees = 0.25;

  /// Points of another LiDAR hide only this near to the ray, if that is less. Two LiDARs have rings
  /// between each other's, and their points on the ground must hide nothing: seen from 1.5 m above
  /// it, a point that is kHidingShare nearer is more than 7 cm off the ray.
  static constexpr double kHidingDistance = 0.06;  ///< m

  /// Two points at an edge of depth differ in their distance from the camera by more than this: the
  /// larger of the two. The ground at 15 m differs by 5 % from ring to ring.
  static constexpr double kEdgeStep = 0.5;    ///< m
  static constexpr double kEdgeShare = 0.10;  ///< of the nearer one's
  static constexpr double kEdgePixels = 5;    ///< and their projections by less than this

  /// @param scan_lidar  the whole scan, motion compensated: points at any range hide others
  ScanProjection(const PointCloud& scan_lidar, const Camera& camera);

  /// Whether another point hides this point of the scan from the camera.
  /// @param pixel, distance  of the point (distance from the camera, m)
  /// @param sensor           number of the LiDAR that measured it
  bool hidden(const Eigen::Vector2d& pixel, double distance, std::uint16_t sensor = 0) const;

  /// Whether the point is at an edge of depth, on either side of it.
  bool near_edge(const Eigen::Vector2d& pixel, double distance) const;

 private:
  struct Point {
    float u, v, distance;
    std::uint16_t sensor;
  };
  /// Whether `test(point, pixels2)` holds for any point within `radius` pixels.
  /// pixels2: square of its distance in the image
  template <class Test>
  bool any_within(const Eigen::Vector2d& pixel, double radius, Test&& test) const;
  int column_of(double u) const;
  int row_of(double v) const;

  int columns_, rows_;
  double hiding_radius_;              // pixels
  double focal_;                      // pixels
  std::vector<std::uint32_t> first_;  // of each cell in points_
  std::vector<Point> points_;
};

/// Drops the points that another point of the scan hides from the camera. Returns how many.
/// @param points_cam  of the scan, all in view
std::size_t drop_hidden(PointCloud& points_cam, const PointCloud& scan_lidar, const Camera& camera);

}  // namespace fovea
