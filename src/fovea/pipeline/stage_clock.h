// Wall time of the stages of a frame.
#pragma once

#include <chrono>
#include <map>
#include <string>
#include <utility>

namespace fovea {

class StageClock {
 public:
  /// Runs `work`, adds its wall time to `stage` and returns what it returns.
  template <class Work>
  decltype(auto) time(const char* stage, Work&& work) {
    const Timer timer{milliseconds_[stage]};
    return std::forward<Work>(work)();
  }
  const std::map<std::string, double>& milliseconds() const { return milliseconds_; }

 private:
  using Clock = std::chrono::steady_clock;
  struct Timer {
    double& total;
    Clock::time_point start = Clock::now();
    explicit Timer(double& total_) : total(total_) {}
    ~Timer() { total += std::chrono::duration<double, std::milli>(Clock::now() - start).count(); }
  };
  std::map<std::string, double> milliseconds_;
};

}  // namespace fovea
