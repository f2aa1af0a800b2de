// Samples of the surfaces in a camera's view, on a regular grid with the map's resolution
// (docs/method.md 3). The paper upsamples instead.
#pragma once

#include <functional>

#include "fovea/core/point_cloud.h"
#include "fovea/geometry/camera.h"
#include "fovea/mapping/surface.h"

namespace fovea {

/// The grid of the samples: cells of the finest level; at each further level twice as large.
struct SampleGrid {
  RigidMotion T_grid_cam;
  double cell = 0;  ///< edge of a finest cell, m
  /// Whether the cell of a level around a point already has a point, of this level or a finer one;
  /// called from several threads.
  std::function<bool(const Eigen::Vector3d& p_grid, int level)> taken;
  /// Positions will be rounded to multiples of this, m; 0: not rounded. The cell of a point is that
  /// of its rounded position. Otherwise each scan would add the point again.
  double step = 0;
};

/// Finds the surface, and samples each of its triangles where the centers of the cells of its level
/// project onto it along one axis: that nearest to its normal. Samples of all frames and triangles
/// therefore share the same positions.
///
/// @param points_cam  as for find_surface()
/// @return the points in free cells in their order, then the samples with the mean intensity of
///         their corners: at most one for each cell of a level. Has the columns of upsample(),
///         normals and levels; `reason` tells which rule admitted the triangle.
PointCloud sample_surfaces(const PointCloud& points_cam, const Camera& camera,
                           const SurfaceOptions& options, const SampleGrid& grid);

}  // namespace fovea
