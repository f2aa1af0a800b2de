// Poses or positions that came with a drive as tables (docs/drives.md).
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "fovea/core/messages.h"
#include "fovea/drive/drive_description.h"
#include "fovea/drive/scans/csv_rows.h"
#include "fovea/drive/stamp_units.h"
#include "fovea/geometry/geodesy.h"
#include "fovea/trajectory.h"

namespace fovea {

/// poses.csv, or else gnss.csv with or without imu.csv, before they are converted.
struct NavigationTables : Messages {
  std::optional<CsvRows> poses;         ///< kPoseColumns
  std::optional<CsvRows> positions;     ///< kPositionColumns; not used with poses
  std::optional<CsvRows> orientations;  ///< kOrientationColumns
  /// rad, of the body before the first position, where nothing states attitudes.
  std::optional<double> heading_before;
};

/// Where the frame `local` lies.
struct LocalFrame {
  TimeNs time =
      0;  ///< the LiDAR is at its origin then, or at the first pose, where poses begin later
  std::optional<GeodeticPoint> point = {};    ///< of positions: its origin lies here instead
  std::optional<Eigen::Vector3d> world = {};  ///< of poses: its origin lies here in their world
};

struct GenericNavigation : Messages {
  std::optional<Trajectory> T_local_lidar;  ///< absent: none of the files is there or of use
  std::vector<double> accuracy;             ///< see DriveInfo::navigation_accuracy
  std::optional<GeodeticPoint> origin;  ///< of `local`; absent with poses.csv, and without a fix
  LocalFrame frame;                     ///< of `local`: with its place, where poses are of use
  bool headings_by_way = false;         ///< nothing states attitudes of positions
};

/// The tables of a drive's folder. The time of the scans, where it is known, shows the unit of
/// times. InputError if a file cannot be read or lacks a column.
NavigationTables read_navigation_tables(const std::filesystem::path& folder,
                                        const std::optional<ScanPeriod>& scans);

/// Poses of the LiDAR by the tables. Lines that cannot be used are left out and noted.
/// InputError for positions and poses of wrong units.
/// @param folder  of the tables, for messages
GenericNavigation convert_navigation(NavigationTables tables, const std::filesystem::path& folder,
                                     const DriveDescription& drive, const LocalFrame& frame);

/// Reads and converts the tables of a drive's folder. With poses.csv, local has the axes of the
/// poses' world and its origin where the LiDAR was at `origin_time`, or at the first pose, where
/// they do not reach that time; with gnss.csv it is east-north-up there.
GenericNavigation read_generic_navigation(const std::filesystem::path& folder,
                                          const DriveDescription& drive, TimeNs origin_time,
                                          const std::optional<ScanPeriod>& scans);

}  // namespace fovea
