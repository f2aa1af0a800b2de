// The surfaces that a camera sees: triangles between a scan's projected points, and their normals
// (goes past the paper; docs/method.md 3).
#pragma once

#include <cstdint>
#include <vector>

#include "fovea/base/point_cloud.h"
#include "fovea/geometry/camera.h"
#include "fovea/mapping/image_mesh.h"

namespace fovea {

struct SurfaceOptions {
  double spacing = 0.02;     ///< of the samples, m; 0: the paper's upsampling in their place
  double max_edge = 0.4;     ///< a triangle of shorter edges is surface (m)
  double planar_edge = 1.0;  ///< longest edge where the surface is flat (m)
  double planar_angle = 0.5235987755982988;  ///< between normals on two sides of an edge there, rad
  /// Samples in a pixel of the image, at most; 0: no limit. Where more cells fall onto a pixel,
  /// far away and at a slant, only every second, fourth or eighth is sampled until a camera is
  /// nearer: the image has nothing to tell the others apart by.
  double max_per_pixel = 4;
  void validate() const;  ///< ConfigError that names the field
};

/// The triangles between a cloud's projected points that are surface, and its normals.
struct Surface {
  ImageMesh mesh;
  std::vector<DelaunayTriangulation::Vertices> triangles;
  std::vector<PointRule> rule;                   ///< by triangle: why it is surface
  std::vector<Eigen::Vector3f> vertex_normal;    ///< of the mesh's; zero without a triangle
  std::vector<Eigen::Vector3f> triangle_normal;  ///< the mean of its corners'
  std::vector<std::uint8_t> halvings;  ///< by triangle: one in 2^n of its cells is sampled

  static constexpr std::uint8_t kMostHalvings = 3;
};

/// Finds the surface among the triangles between the projected points (2D Delaunay, as upsample()
/// has them).
///
/// A triangle is surface if its edges are shorter than max_edge. Rings of a LiDAR fall onto the far
/// ground more than that apart: one of edges up to planar_edge is surface, too, if the surface goes
/// on straight across each of its edges. Across a gap in depth it does not: one of the edges there
/// belongs to what is before or behind. Normals are smoothed over neighbouring triangles.
///
/// @param points_cam  camera frame, origin 0, all more than Camera::kMinDepth in front of it
Surface find_surface(const PointCloud& points_cam, const Camera& camera,
                     const SurfaceOptions& options);

}  // namespace fovea
