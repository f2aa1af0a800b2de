// The points of a PointCloud2 message.
#pragma once

#include "fovea/drive/recordings/ros_messages.h"
#include "fovea/drive/scans/lidar_scan.h"

namespace fovea {

/// Passes the points on. InputError that names `where` for a cloud whose fields do not fit its
/// data, or without x y z.
void read_cloud_rows(const ros::PointCloud2& message, const std::string& where, CloudRows& rows);

}  // namespace fovea
