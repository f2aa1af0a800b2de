// How the numbers in the files of scans count.
#pragma once

#include <optional>

namespace fovea {

/// What the time of a point counts from.
enum class TimeReference {
  kStamp,       ///< the scan's stamp
  kAbsolute,    ///< the epoch of the stamps
  kFirstPoint,  ///< any moment: the scan's stamp is the time of its first point
  kNone,        ///< nothing: points have no times, whatever their columns are called
};

struct ScanFormat {
  double intensity_max = 1;  ///< the value that stands for a reflectance of 1
  double length_unit = 1;    ///< m, of the coordinates
  TimeReference time_reference = TimeReference::kStamp;
  /// s, of the points' times; absent: nanoseconds where they are whole numbers, or else seconds.
  std::optional<double> time_unit;
};

/// What drive.toml states of the ScanFormat; absent: recognized.
struct StatedScanFormat {
  std::optional<double> intensity_max, length_unit, time_unit;
  std::optional<TimeReference> time_reference;
};

}  // namespace fovea
