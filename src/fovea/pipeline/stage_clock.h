// Wall time of the stages of a frame.
#pragma once

#include <map>
#include <string>
#include <utility>

#include "fovea/base/wall_clock.h"

namespace fovea {

class StageClock {
 public:
  /// Runs `work`, adds its wall time to `stage` and returns its result.
  template <class Work>
  decltype(auto) time(const char* stage, Work&& work) {
    const Timer timer{milliseconds_[stage]};
    return std::forward<Work>(work)();
  }
  /// Adds the times of another clock, possibly from another thread.
  void add(const StageClock& other) {
    for (const auto& [stage, milliseconds] : other.milliseconds_) {
      milliseconds_[stage] += milliseconds;
    }
  }
  const std::map<std::string, double>& milliseconds() const { return milliseconds_; }

 private:
  struct Timer {
    double& total;
    WallClock::time_point start = WallClock::now();
    explicit Timer(double& total_) : total(total_) {}
    ~Timer() { total += milliseconds_since(start); }
  };
  std::map<std::string, double> milliseconds_;
};

}  // namespace fovea
