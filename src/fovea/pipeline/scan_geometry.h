// Scan and cameras of a frame, at the scan's stamp.
#pragma once

#include <optional>
#include <vector>

#include "fovea/drive/frame_source.h"
#include "fovea/mapping/inertial_filter.h"

namespace fovea {

/// The scan with the sweep's motion undone, where the scans of the drive are raw and the motion is
/// given. Without the columns of times and rings.
PointCloud deskewed(const PointCloud& scan, const std::optional<SweepMotion>& motion,
                    const DriveInfo& drive);

/// From the first point of a scan to the last one, about its stamp.
SweepSpan sweep_span(const PointCloud& scan, const DriveInfo& drive);

/// The drive's cameras, each where it took its image of a frame. lidar_views() of a drive without
/// cameras.
std::vector<Camera> frame_cameras(const DriveInfo& drive, const Frame& frame,
                                  const std::optional<SweepMotion>& motion);

/// The points that a mask does not cover.
/// @param points_cam  camera frame, all in view
/// @param mask        nullptr: all
std::vector<Eigen::Vector3f> unmasked(const std::vector<Eigen::Vector3f>& points_cam,
                                      const Camera& camera, const ImageMask* mask);

}  // namespace fovea
