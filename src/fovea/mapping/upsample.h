// Constrained Delaunay upsampling (paper: Pose Refinement; docs/method.md 3).
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
/// The points are projected into `camera` and their pixels, on a grid of 1/1024 pixel, triangulated
/// (2D Delaunay). Every triangle whose three 3D edges are shorter than max_edge gets its 3D
/// centroid as a new point, whose own pixel becomes a new vertex; repeated `rate` times. Of points
/// that share a grid point the nearest to the camera is the vertex; the others are kept in the
/// cloud as they are, and so are points more than 2^19 pixels outside the image. A centroid on the
/// grid point of a vertex is not added.
///
/// @param points_cam  points in the camera's frame, all more than Camera::kMinDepth in front of it
///                    (std::invalid_argument otherwise); they need not be inside the image. Of the
///                    columns present, intensity, range and incidence are averaged; color, frame
///                    and camera are those of one of the triangle's corners
/// @return the input points in their order, then the new ones, with three columns set:
///         `interpolated` (1 for new points, as it was for the others), `reason` likewise
///         (PointRule::kCentroid), and `normal` (camera frame, unit, towards
///         the camera): of a new point, its triangle's; of an input point, the area-weighted mean
///         of the triangles of input points below max_edge around it, or zero without any; of one
///         that shares a grid point, the vertex's if that is within 5 cm, or zero
PointCloud upsample(const PointCloud& points_cam, const Camera& camera,
                    const UpsampleOptions& options);

}  // namespace fovea
