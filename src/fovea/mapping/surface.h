// Surfaces in a camera's view: triangles between a scan's projected points, and their normals
// (docs/method.md 3; not in the paper).
#pragma once

#include <cstdint>
#include <vector>

#include "fovea/mapping/image_mesh.h"
#include "fovea/surface_samples.h"

namespace fovea {

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
