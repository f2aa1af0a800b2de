// Unit and reference of the times of points.
#pragma once

#include <optional>
#include <span>
#include <string>

#include "fovea/drive/scans/scan_format.h"
#include "fovea/drive/scans/scan_numbers.h"

namespace fovea {

struct PointTimes {
  TimeReference reference = TimeReference::kStamp;
  std::optional<double> unit;  ///< as ScanFormat::time_unit
  std::string note;            ///< what was recognized; empty if it is usual or stated
};

/// Drivers agree neither on the unit nor on the reference. The span of the times gives the unit:
/// a sweep takes 2 ms to 2 s. The distance from the stamps, and whether the times advance with
/// them, gives the reference. Times that are all equal are none.
/// ConfigError whose place is the key of drive.toml: for times that have no meaning or several, and
/// for a stated value that cannot be right.
PointTimes recognize_point_times(std::span<const ScanNumbers> scans,
                                 const StatedScanFormat& stated);

}  // namespace fovea
