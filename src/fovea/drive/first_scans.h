// What the first scans of a drive show about all its scans.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "fovea/core/read_file.h"
#include "fovea/drive/scans/scan_format.h"
#include "fovea/drive/scans/scan_numbers.h"
#include "fovea/point_cloud.h"
#include "fovea/time.h"

namespace fovea {

using StampOfScan = std::function<std::optional<TimeNs>(int scan)>;

/// The numbers of up to `count` scans that have a stamp. Damaged scans do not count.
std::vector<ScanNumbers> read_first_numbers(const NumberedFiles& scans, int count,
                                            const StampOfScan& stamp);

/// Middle of the times of a scan's points, s from the stamp; absent if they have none.
std::optional<double> sweep_middle(const PointCloud& scan);

/// sweep_middle() of the first scan that can be read;
/// absent if its points have no times.
std::optional<double> first_sweep_middle(const NumberedFiles& scans, const ScanFormat& format,
                                         const StampOfScan& stamp);

}  // namespace fovea
