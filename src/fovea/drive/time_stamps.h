// KITTI's time stamp files: one line a frame.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string_view>
#include <vector>

#include "fovea/time.h"

namespace fovea {

struct TimeStamps {
  /// One a line, from frame 0 on. Empty where the line is blank (KITTI's sign of a missing frame; a
  /// reader that closed the gap would shift every later frame), malformed or out of order.
  std::vector<std::optional<TimeNs>> times;
  std::vector<int> malformed;     ///< lines (from 0) that are neither blank nor a time
  std::vector<int> out_of_order;  ///< lines whose time does not fit an increasing sequence
  bool any() const;
};

/// Takes out the fewest times that leave an increasing sequence, the later of equal choices, so
/// that one wild stamp costs one frame and not all that follow it; they are listed as out of order.
void remove_out_of_order(TimeStamps& stamps);

/// "2011-09-26 13:08:24.967930880" as nanoseconds since the Unix epoch, exactly; digits beyond
/// nanoseconds are cut off. Empty if malformed.
std::optional<TimeNs> parse_date_time(std::string_view text);

/// timestamps.txt of a raw drive. InputError if the file cannot be read.
TimeStamps read_date_times(const std::filesystem::path& file);

/// times.txt of an odometry sequence: seconds. InputError if the file cannot be read.
TimeStamps read_seconds(const std::filesystem::path& file);

/// Median step between neighbouring lines that both have a time, s; empty if there are none.
/// Missing frames do not disturb it.
std::optional<double> median_period(const TimeStamps& stamps);

}  // namespace fovea
