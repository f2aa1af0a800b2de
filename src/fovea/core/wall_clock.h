// Wall time, for figures of how long things take.
#pragma once

#include <chrono>

namespace fovea {

using WallClock = std::chrono::steady_clock;

inline double milliseconds(WallClock::duration duration) {
  return std::chrono::duration<double, std::milli>(duration).count();
}

inline double milliseconds_since(WallClock::time_point start) {
  return milliseconds(WallClock::now() - start);
}

}  // namespace fovea
