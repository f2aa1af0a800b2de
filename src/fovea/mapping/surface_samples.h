// Samples of the surfaces that a camera sees, on a regular grid: as finely as the map is to be
// (goes past the paper; docs/method.md 3).
#pragma once

#include <functional>

#include "fovea/base/point_cloud.h"
#include "fovea/geometry/camera.h"
#include "fovea/geometry/cell_brick.h"
#include "fovea/mapping/image_mesh.h"

namespace fovea {

struct SurfaceOptions {
  double spacing = 0.0185;   ///< of the samples, m; 0: the paper's upsampling in their place
  double max_edge = 0.4;     ///< a triangle of shorter edges is surface (m)
  double planar_edge = 1.0;  ///< longest edge where the surface is flat (m)
  double planar_angle = 0.5235987755982988;  ///< between normals on two sides of an edge there, rad
  /// Samples in a pixel of the image, at most; 0: no limit. Where more cells fall onto a pixel,
  /// far away and at a slant, only every second, fourth or eighth is sampled until a camera is
  /// nearer: the image has nothing to tell the others apart by.
  double max_per_pixel = 4;
  void validate() const;  ///< ConfigError that names the field
};

/// The grid that samples lie on.
struct SampleGrid {
  RigidMotion T_grid_cam;
  double cell = 0;  ///< edge of its cubes, m
  /// Whether there is a point already in the cell of this one; called from many threads.
  std::function<bool(const Eigen::Vector3d& p_grid)> taken;
  /// Cells that are taken besides, a brick by its number (CellBrick::number_of), nullptr where none
  /// is; for many cells, of which neighbours share a brick.
  std::function<const CellBrick*(const Eigen::Array3i& brick)> taken_brick =
      [](const Eigen::Array3i&) { return nullptr; };
  /// Positions will be rounded to multiples of it, m; 0: they will not. A point's cell is where it
  /// will be, or with each scan it would be added anew.
  double step = 0;
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

/// Each triangle is looked at along the axis of the grid nearest to its normal, and sampled where
/// centres of cells fall onto it: samples of all frames and triangles have the same places.
///
/// @param points_cam  those whose surface it is
/// @return the points, in their order, then the samples (intensity: mean of the corners'), without
///         those in taken cells, and one for each cell; columns as upsample() gives them, and
///         normals; `reason` says which edges admitted a sample's triangle
PointCloud sample_surface(const PointCloud& points_cam, const Surface& surface,
                          const SampleGrid& grid);

/// Both, one after the other.
PointCloud sample_surfaces(const PointCloud& points_cam, const Camera& camera,
                           const SurfaceOptions& options, const SampleGrid& grid);

}  // namespace fovea
