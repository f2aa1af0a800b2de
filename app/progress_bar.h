// A progress bar on standard error, where that is a terminal.
#pragma once

#include <chrono>
#include <string_view>

#include "fovea/pipeline/map_drive.h"

namespace fovea::app {

class ProgressBar {
 public:
  /// @param quiet  draw nothing, whatever standard error is
  /// @param unit   what is counted
  explicit ProgressBar(bool quiet, std::string_view unit = "frames");
  ~ProgressBar();  ///< ends the line
  void operator()(const MapProgress& progress);
  /// @param detail  shown between the rate and the time left
  void draw(int done, int total, std::string_view detail = "");

 private:
  bool enabled_;
  std::string_view unit_;
  bool drawn_ = false;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace fovea::app
