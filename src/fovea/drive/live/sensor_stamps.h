// The stamps of a sensor, as they come.
#pragma once

#include <cstddef>
#include <deque>
#include <optional>

#include "fovea/time.h"

namespace fovea {

/// A sensor that has sent nothing for so long, while others go on, has stopped.
inline constexpr TimeNs kStoppedAfter = 2 * kNsPerSecond;

/// Rate and gaps.
class SensorStamps {
 public:
  /// @param stamp  after the one before
  void add(TimeNs stamp);

  /// Median of the latest steps; absent before there are some.
  std::optional<TimeNs> usual_step() const;
  const std::optional<TimeNs>& last() const { return last_; }
  /// The sensor has sent nothing for a frame. Frames without data after a pause of all sensors are
  /// few.
  void miss() { ++misses_; }
  /// Whether the sensor has stopped before a time: it is not waited for.
  bool has_stopped(TimeNs time) const {
    return last_ && time - *last_ > kStoppedAfter && misses_ >= kMisses;
  }
  /// Messages that are missing in gaps, as missing_messages() counts them: while the rate is
  /// steady. A longer gap than kStoppedAfter is a pause.
  std::size_t missing() const { return missing_; }

 private:
  bool is_steady(TimeNs usual) const;

  std::deque<TimeNs> steps_;  // the latest ones
  std::optional<TimeNs> last_;
  static constexpr std::size_t kMisses = 3;
  std::size_t missing_ = 0, misses_ = 0;
};

}  // namespace fovea
