// The points of a scan in memory, as the reader of a file passes them on.
#pragma once

#include <string>

#include "fovea/core/point_formats/cloud_rows.h"
#include "fovea/drive/scans/lidar_scan.h"
#include "fovea/point_cloud.h"

namespace fovea {

/// Passes on the columns x, y, z and intensity, and time (s) and ring where the scan has them.
/// InputError that names the scan for a column of another length than the positions.
void read_points(const PointCloud& scan, const std::string& name, CloudRows& rows);

/// The usable points, in the units of the format. InputError if there are none.
/// @param stamp  of the scan
LidarScan usable_points(const PointCloud& scan, const ScanFormat& format, TimeNs stamp,
                        const std::string& name);

/// InputError as read_points().
ScanNumbers numbers_of(const PointCloud& scan, TimeNs stamp, const std::string& name);

}  // namespace fovea
