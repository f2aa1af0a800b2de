// Constrained Delaunay upsampling (paper: Pose Refinement; docs/method.md 3).
#pragma once

#include <cstdint>
#include <vector>

#include "fovea/camera.h"
#include "fovea/point_cloud.h"

namespace fovea {

struct UpsampleOptions {
  int rate = 2;           ///< how often centroids are inserted, 0-5
  double max_edge = 0.3;  ///< tau: longest 3D edge of a triangle that is filled (m)
};

/// Adds points on the triangles of a cloud's image projection.
///
/// Projects the points into `camera` and triangulates their pixels on a grid of 1/1024 pixel (2D
/// Delaunay). Each triangle whose three 3D edges are shorter than max_edge gets its 3D centroid as
/// a new point, whose pixel becomes a new vertex. This repeats `rate` times. If points share a grid
/// point, the nearest to the camera is the vertex. The others stay in the cloud unchanged, as do
/// points more than 2^19 pixels outside the image. A centroid at an existing vertex is not added.
///
/// @param points_cam  points in the camera's frame, all more than Camera::kMinDepth in front of it
///                    (std::invalid_argument otherwise), inside or outside the image. New points
///                    have the mean intensity, range and incidence of the triangle's corners, and
///                    color, frame and camera of one of them
/// @return the input points in their order, then the new ones, with three columns set:
///         `interpolated` (1 for new points), `reason` (PointRule::kCentroid for new points), and
///         `normal` (camera frame, unit, towards the camera). A new point has the normal of its
///         triangle. An input point has the area-weighted mean of the triangles of input points
///         below max_edge around it, or zero without any. A point that shares a grid point has the
///         normal of the vertex if that is within 5 cm, or zero
FOVEA_API PointCloud upsample(const PointCloud& points_cam, const Camera& camera,
                              const UpsampleOptions& options);

/// Constrained upsampling before registration: densifies the points in view of a camera except for
/// ground points, which stay as they are. Each point belongs to the first camera that sees it.
/// Points outside all cameras are dropped.
/// @param is_ground  1 for a ground point, by point of the scan
/// @return positions in the LiDAR frame, m
FOVEA_API std::vector<Eigen::Vector3f> upsample_non_ground(
    const PointCloud& scan_lidar, const std::vector<std::uint8_t>& is_ground,
    const std::vector<Camera>& cameras, const UpsampleOptions& options);

}  // namespace fovea
