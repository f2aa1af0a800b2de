// gnss.csv with or without imu.csv (docs/drives.md).
#pragma once

#include "fovea/drive/navigation/generic_navigation.h"

namespace fovea {

/// Reads the tables of a drive's folder; see read_generic_navigation().
GenericNavigation read_gnss(const std::filesystem::path& folder, const DriveDescription& drive,
                            TimeNs origin_time, const std::optional<ScanPeriod>& scans);

}  // namespace fovea
