// The Delaunay triangulation of a cloud's projection into an image.
#pragma once

#include <optional>
#include <vector>

#include "fovea/camera.h"
#include "fovea/mapping/delaunay.h"
#include "fovea/point_cloud.h"

namespace fovea {

/// Projects a cloud in the camera's frame onto the grid of the triangulation. A step is 1/1024
/// pixel, far below the noise of a LiDAR; the grid covers 2^19 pixels.
class GridProjection {
 public:
  /// @param origin  of the cloud
  GridProjection(const Camera& camera, const Eigen::Vector3d& origin)
      : camera_(camera), origin_(origin) {}

  Eigen::Vector3d from_camera(const Eigen::Vector3f& position) const {
    return origin_ + position.cast<double>();
  }
  /// Empty for a point behind the camera or beyond the grid.
  std::optional<GridPoint> operator()(const Eigen::Vector3f& position) const;

 private:
  const Camera& camera_;
  Eigen::Vector3d origin_;
};

/// Columns by vertex: measured ones first, then those that a user inserts.
struct ImageMesh {
  static constexpr std::int32_t kNoVertex = -1;

  DelaunayTriangulation triangulation;
  std::vector<Eigen::Vector3f> position;
  std::vector<std::int32_t> vertex_of_point;   ///< by point of the cloud; kNoVertex off the grid
  std::vector<std::uint32_t> point_of_vertex;  ///< by measured vertex

  /// Triangulates the projection. If points share a grid point, the nearest to the camera becomes
  /// the vertex. std::invalid_argument if a point is not in front of the camera.
  ImageMesh(const PointCloud& points_cam, const GridProjection& project);

  bool edges_below(const DelaunayTriangulation::Vertices& corners, float max_edge_squared) const;

  /// Normal of a triangle, towards the camera; its length is twice the area.
  Eigen::Vector3f area_normal(const DelaunayTriangulation::Vertices& corners,
                              const GridProjection& project) const;
};

/// A vector of length zero stays zero.
inline Eigen::Vector3f unit_or_zero(const Eigen::Vector3f& v) {
  const float length = v.norm();
  return length > 0 ? Eigen::Vector3f(v / length) : Eigen::Vector3f::Zero();
}

}  // namespace fovea
