// Progress on standard error: a bar where that is a terminal, else a line now and then.
#pragma once

#include <chrono>
#include <string_view>

#include "app/progress_text.h"
#include "fovea/pipeline/map_drive.h"

namespace fovea::app {

class ProgressBar {
 public:
  /// @param quiet  say nothing
  /// @param unit   what is counted
  explicit ProgressBar(bool quiet, std::string_view unit = "frames");
  ~ProgressBar();  ///< ends the line
  void operator()(const RunProgress& progress);
  /// @param detail  what else to tell
  void draw(int done, int total, std::string_view detail = "");

 private:
  bool quiet_, on_terminal_;
  std::string_view unit_;
  bool drawn_ = false;
  double last_line_ = 0;  // s since the start
  ProgressRate rate_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace fovea::app
