// Constrained Delaunay upsampling (paper: Pose Refinement; SPEC section 3).
#pragma once

#include "fovea/base/point_cloud.h"
#include "fovea/geometry/camera.h"

namespace fovea {

struct UpsampleOptions {
  int rate = 2;           ///< how often centroids are inserted, 0-5
  double max_edge = 0.3;  ///< tau: longest 3D edge of a triangle that is filled (m)
  /// ConfigError that names the field.
  void validate() const;
};

/// Densifies a cloud on the triangles of its image projection.
///
/// The points are projected into `camera` and their pixels triangulated (2D Delaunay). Every
/// triangle whose three 3D edges are shorter than max_edge gets its 3D centroid as a new point,
/// whose own pixel becomes a new vertex; repeated `rate` times. Of points that share a pixel (on
/// the fixed-point grid) the nearest to the camera is the vertex; the others are kept in the cloud
/// as they are.
///
/// @param points_cam  points in the camera's frame, all in front of it; columns that are present
///                    (intensity, frame, ...) are averaged or taken from the triangle's first
///                    vertex
/// @return the input points in their order, then the new ones, with two columns set: `interpolated`
///         (1 for new points) and `normal` (camera frame, unit, towards the camera; zero where no
///         triangle below max_edge meets the point)
PointCloud upsample(const PointCloud& points_cam, const Camera& camera,
                    const UpsampleOptions& options);

}  // namespace fovea
