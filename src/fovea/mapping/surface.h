// Surfaces in a camera's view: triangles between a scan's projected points, and their normals
// (docs/method.md 3; not in the paper).
#pragma once

#include <cstdint>
#include <vector>

#include "fovea/core/point_cloud.h"
#include "fovea/geometry/camera.h"
#include "fovea/mapping/image_mesh.h"

namespace fovea {

struct SurfaceOptions {
  double spacing = 0.02;                     ///< of the samples, m
  double max_edge = 0.4;                     ///< m: triangles with shorter edges are surface
  double planar_edge = 1.0;                  ///< m: the same where the surface is flat
  double planar_angle = 0.5235987755982988;  ///< rad, between the normals on both sides of an edge
  /// Largest number of samples in a pixel; 0: no limit. If more cells project to a pixel, only
  /// every second, fourth or eighth is sampled: the image cannot resolve more.
  double max_per_pixel = 4;
};

/// The surface triangles between a cloud's projected points, and their normals.
struct Surface {
  ImageMesh mesh;
  std::vector<DelaunayTriangulation::Vertices> triangles;
  std::vector<PointRule> rule;                   ///< by triangle: the rule that admits it
  std::vector<Eigen::Vector3f> vertex_normal;    ///< by vertex of the mesh; zero without a triangle
  std::vector<Eigen::Vector3f> triangle_normal;  ///< mean of its corners
  std::vector<std::uint8_t> halvings;  ///< by triangle: one in 2^n of its cells is sampled

  static constexpr std::uint8_t kMostHalvings = 3;
};

/// Selects the surface among the triangles between the projected points (2D Delaunay, as in
/// upsample()).
///
/// A triangle is surface if its edges are shorter than max_edge. Rings of a LiDAR are further apart
/// on the far ground. A triangle with edges up to planar_edge is therefore surface too, if the
/// surface continues straight across each of its edges. Across a gap in depth it does not, since
/// one edge there belongs to an object in front or behind. Normals are smoothed over neighboring
/// triangles.
///
/// @param points_cam  camera frame, origin 0, all more than Camera::kMinDepth in front of it
Surface find_surface(const PointCloud& points_cam, const Camera& camera,
                     const SurfaceOptions& options);

}  // namespace fovea
