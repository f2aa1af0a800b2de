// The points of a PointCloud2 message.
#pragma once

#include "fovea/rosbag/ros_messages.h"
#include "fovea/sensor/lidar_scan.h"

namespace fovea {

/// Hands on the points. `reflectivity` stands in for an `intensity` that is not there. InputError
/// that names `where` for a cloud whose fields do not fit its data, without x y z, or big endian.
void read_cloud_rows(const ros::PointCloud2& message, const std::string& where, CloudRows& rows);

/// How the points' times are to be read. Drivers agree neither on the unit nor on what they count
/// from; what the times of a scan are near and how far apart they are tells both: a sweep takes 5
/// ms to 1 s. TimeReference::kNone if the cloud has no times, or none that make sense.
ScanFormat time_format_of(const ros::PointCloud2& message, const std::string& where);

}  // namespace fovea
