// Surfaces in a camera's view: triangles between a scan's projected points, and their normals
// (docs/method.md 3; not in the paper).
#pragma once

#include <cstdint>
#include <limits>
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
  /// About this many samples in a pixel, 0: no limit. If more of the finest cells project to a
  /// pixel, cells of 2, 4, 8 or 16 times their edge are sampled: the image cannot resolve more.
  double max_per_pixel = 4;
  /// m from the camera: beyond, one sample in a pixel suffices, and no cell is of the finest level.
  /// Nearer frames will measure the surface better, and replace these samples.
  double full_density_range = std::numeric_limits<double>::infinity();
};

/// The surface triangles between a cloud's projected points, and their normals.
struct Surface {
  ImageMesh mesh;
  std::vector<DelaunayTriangulation::Vertices> triangles;
  std::vector<PointRule> rule;                   ///< by triangle: the rule that admits it
  std::vector<Eigen::Vector3f> vertex_normal;    ///< by vertex of the mesh; zero without a triangle
  std::vector<Eigen::Vector3f> triangle_normal;  ///< mean of its corners
  std::vector<std::uint8_t> level;               ///< by triangle: the sampling level
};

/// The level at which a surface is sampled, so that a pixel has between half and twice as many
/// samples as the options say.
/// @param normal  of length 1
std::uint8_t sampling_level(const Eigen::Vector3d& p_cam, const Eigen::Vector3d& normal,
                            const Camera& camera, const SurfaceOptions& options);

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
