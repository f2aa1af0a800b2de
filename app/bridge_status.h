// How reading a running robot proceeds, as lines on standard error.
#pragma once

#include <chrono>
#include <string>

#include "app/print.h"

namespace fovea::app {

/// Prints a line each time something changes, and each ten seconds.
class BridgeStatus {
 public:
  explicit BridgeStatus(bool quiet) : quiet_(quiet) {}

  /// @param missing  what a drive lacks so far; empty: nothing
  /// @param usual    the line if there is no problem; empty: none
  void show(bool is_connected, const std::string& missing, const std::string& usual = "") {
    const std::string problem = !is_connected      ? "the connection is lost; trying again"
                                : !missing.empty() ? "still missing: " + missing
                                                   : std::string();
    if (quiet_ || (problem == last_ && Clock::now() < next_)) return;
    last_ = problem;
    next_ = Clock::now() + std::chrono::seconds(10);
    const std::string& line = problem.empty() ? usual : problem;
    if (!line.empty()) print_err("{}\n", line);
  }

 private:
  using Clock = std::chrono::steady_clock;

  bool quiet_;
  std::string last_;
  Clock::time_point next_ = Clock::now() + std::chrono::seconds(1);
};

}  // namespace fovea::app
