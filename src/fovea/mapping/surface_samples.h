// Samples of the surfaces that a camera sees, on a regular grid: as finely as the map is to be
// (goes past the paper; docs/method.md 3).
#pragma once

#include <functional>

#include "fovea/base/point_cloud.h"
#include "fovea/geometry/camera.h"
#include "fovea/geometry/cell_brick.h"
#include "fovea/mapping/surface.h"

namespace fovea {

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
