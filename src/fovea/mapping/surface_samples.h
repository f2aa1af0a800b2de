// Samples of the surfaces in a camera's view, on a regular grid with the map's resolution
// (docs/method.md 3). The paper upsamples instead.
#pragma once

#include <functional>

#include "fovea/core/point_cloud.h"
#include "fovea/geometry/camera.h"
#include "fovea/geometry/cell_brick.h"
#include "fovea/mapping/surface.h"

namespace fovea {

/// The grid of the samples.
struct SampleGrid {
  RigidMotion T_grid_cam;
  double cell = 0;  ///< edge of a cell, m
  /// Whether the cell of a point already has a point; called from several threads.
  std::function<bool(const Eigen::Vector3d& p_grid)> taken;
  /// More cells that have a point: a brick by its number (CellBrick::number_of), or nullptr. Faster
  /// than `taken`, since neighbors share a brick.
  std::function<const CellBrick*(const Eigen::Array3i& brick)> taken_brick =
      [](const Eigen::Array3i&) { return nullptr; };
  /// Positions will be rounded to multiples of this, m; 0: not rounded. The cell of a point is that
  /// of its rounded position. Otherwise each scan would add the point again.
  double step = 0;
};

/// Samples each triangle where the centers of the grid's cells project onto it along one axis: that
/// nearest to its normal. Samples of all frames and triangles therefore share the same positions.
///
/// @param points_cam  the points of the surface
/// @return the points in free cells in their order, then the samples with the mean intensity of
/// their
///         corners. At most one for each cell. Has the columns of upsample() and
///         normals; `reason` tells which rule admitted the triangle.
PointCloud sample_surface(const PointCloud& points_cam, const Surface& surface,
                          const SampleGrid& grid);

/// find_surface() and sample_surface().
PointCloud sample_surfaces(const PointCloud& points_cam, const Camera& camera,
                           const SurfaceOptions& options, const SampleGrid& grid);

}  // namespace fovea
