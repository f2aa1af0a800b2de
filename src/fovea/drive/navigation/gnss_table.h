// gnss.csv with or without imu.csv (docs/drives.md).
#pragma once

#include "fovea/drive/navigation/generic_navigation.h"

namespace fovea {

/// See convert_navigation().
/// @param tables  with positions
GenericNavigation convert_positions(NavigationTables tables, const std::filesystem::path& folder,
                                    const DriveDescription& drive, const LocalFrame& frame);

}  // namespace fovea
