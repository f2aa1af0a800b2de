// Poses or positions that came with a drive as tables (docs/drives.md).
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "fovea/core/messages.h"
#include "fovea/drive/drive_description.h"
#include "fovea/drive/stamp_units.h"
#include "fovea/geometry/geodesy.h"
#include "fovea/geometry/trajectory.h"

namespace fovea {

/// What poses.csv, or else gnss.csv with or without imu.csv, give.
struct GenericNavigation : Messages {
  std::optional<Trajectory> T_local_lidar;  ///< absent: none of the files is there or of use
  std::vector<double> accuracy;             ///< see DriveInfo::navigation_accuracy
  std::optional<GeodeticPoint> origin;      ///< of `local`; absent with poses.csv
};

/// Reads the files of a drive's folder. With poses.csv, local has the axes of the poses' world and
/// its origin where the LiDAR was at `origin_time`, or at the first pose, where they do not reach
/// that time; with gnss.csv it is east-north-up there. Lines that cannot be used are left out and
/// noted. The time of the scans, where it is known, shows the unit of times. InputError if a file
/// cannot be read or lacks a column.
GenericNavigation read_generic_navigation(const std::filesystem::path& folder,
                                          const DriveDescription& drive, TimeNs origin_time,
                                          const std::optional<ScanPeriod>& scans);

}  // namespace fovea
