// What the first scans of a drive show about all its scans.
#pragma once

#include <functional>
#include <optional>

#include "fovea/base/time.h"
#include "fovea/sensor/intensity_scale.h"
#include "fovea/sensor/lidar_scan.h"
#include "fovea/sensor/read_file.h"

namespace fovea {

struct FirstScans {
  /// Middle of the sweep, s from the stamp, by the point times of the first scan; absent if its
  /// points have no times.
  std::optional<double> sweep_middle;
  bool any = false;      ///< whether a scan could be read
  IntensityScale scale;  ///< of the intensities in the files, in units of format.intensity_max
};

/// Reads up to `count` scans that have a stamp. Damaged scans do not count.
FirstScans read_first_scans(const NumberedFiles& scans, const ScanFormat& format, int count,
                            const std::function<std::optional<TimeNs>(int scan)>& stamp);

}  // namespace fovea
