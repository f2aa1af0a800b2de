// Samples of the surfaces in a camera's view, on a regular grid with the map's resolution
// (docs/method.md 3). The paper upsamples instead.
#pragma once

#include <functional>
#include <limits>

#include "fovea/camera.h"
#include "fovea/point_cloud.h"

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

/// Finds the surface (docs/method.md 3), and samples each of its triangles where the centers of the
/// cells of its level project onto it along one axis: that nearest to its normal. Samples of all
/// frames and triangles therefore share the same positions.
///
/// @param points_cam  camera frame, origin 0, all more than Camera::kMinDepth in front of it
/// @return the points in free cells in their order, then the samples with the mean intensity of
///         their corners: at most one for each cell of a level. Has the columns of upsample(),
///         normals and levels; `reason` tells which rule admitted the triangle.
FOVEA_API PointCloud sample_surfaces(const PointCloud& points_cam, const Camera& camera,
                                     const SurfaceOptions& options, const SampleGrid& grid);

}  // namespace fovea
