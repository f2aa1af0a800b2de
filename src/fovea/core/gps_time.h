// The time of GPS satellites, which knows no leap seconds.
#pragma once

#include <optional>

#include "fovea/time.h"

namespace fovea {

/// Leap seconds between UTC and GPS time at `utc` (nanoseconds since the Unix epoch), by the table
/// up to 2017, the last one so far.
int gps_leap_seconds(TimeNs utc);

/// Seconds since the GPS epoch (6 January 1980) less 1e9, which LAS calls adjusted standard GPS
/// time. Nothing for times before that epoch and after the year 2115: no date of a drive.
std::optional<double> adjusted_gps_seconds(TimeNs utc);

}  // namespace fovea
