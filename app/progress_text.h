// What a progress bar says, without a terminal to say it to.
#pragma once

#include <deque>
#include <string>
#include <string_view>

namespace fovea::app {

/// How fast things get done of late.
class ProgressRate {
 public:
  struct Reading {
    int done = 0, total = 0;
    double per_second = 0;
    double seconds_left = 0;
  };

  /// @param done     how many are done by now; the first call tells of the first one of this run,
  ///                 also where an earlier run has done some
  /// @param seconds  since the start
  Reading at(int done, int total, double seconds);

 private:
  struct Sample {
    double seconds;
    int done;
  };
  std::deque<Sample> recent_;
};

/// "45 s", "2 min 05 s", "1 h 12 min".
std::string duration_text(double seconds);

/// One line: "120 of 1200 frames, 10.2/s, 4.31 M points, 512 MB, 1 min 46 s left".
/// Without total and rest if the total is 0: it is not known.
/// @param detail  what else to tell, or nothing
std::string progress_text(const ProgressRate::Reading& reading, std::string_view unit,
                          std::string_view detail);

/// The line behind a bar, cut to what a terminal has.
/// @param columns  of the terminal; 0 if unknown
std::string progress_bar(const ProgressRate::Reading& reading, std::string_view text, int columns);

}  // namespace fovea::app
