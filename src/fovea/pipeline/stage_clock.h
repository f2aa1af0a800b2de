// Wall time of the stages of a frame.
#pragma once

#include <map>
#include <string>

#include "fovea/core/wall_clock.h"

namespace fovea {

/// Wall time between laps, by stage.
class StageClock {
 public:
  /// The next lap begins now.
  void start() { lap_began_ = WallClock::now(); }
  /// Adds the time since the last lap, or since start(), to a stage.
  void lap(const char* stage) {
    const auto now = WallClock::now();
    milliseconds_[stage] += fovea::milliseconds(now - lap_began_);
    lap_began_ = now;
  }
  const std::map<std::string, double>& milliseconds() const { return milliseconds_; }

 private:
  WallClock::time_point lap_began_ = WallClock::now();
  std::map<std::string, double> milliseconds_;
};

}  // namespace fovea
