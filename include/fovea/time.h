// Time: int64 nanoseconds since an epoch that one drive shares; durations in nanoseconds too.
#pragma once

#include <cstdint>

namespace fovea {

using TimeNs = std::int64_t;

inline constexpr TimeNs kNsPerSecond = 1'000'000'000;

constexpr double seconds(TimeNs duration) { return static_cast<double>(duration) * 1e-9; }

constexpr TimeNs from_seconds(double duration) {
  return static_cast<TimeNs>(duration * 1e9 + (duration < 0 ? -0.5 : 0.5));
}

}  // namespace fovea
