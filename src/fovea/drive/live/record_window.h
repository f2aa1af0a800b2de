// Records of a sensor that measures motion, from their arrival to the frames.
#pragma once

#include <algorithm>
#include <cstddef>
#include <deque>

#include "fovea/drive/live/sensor_stamps.h"

namespace fovea {

/// Records in the order of their stamps: those that no frame has had, and a few seconds before
/// them.
template <class Record>
class RecordWindow {
 public:
  /// @return false if the record is not later than the one before: it is dropped
  bool add(const Record& record) {
    if (stamps_.last() && record.time <= *stamps_.last()) return false;
    stamps_.add(record.time);
    records_.push_back(record);
    if (records_.size() > kMost) records_.pop_front();
    return true;
  }
  void drop_before(TimeNs time) {
    while (!records_.empty() && records_.front().time < time) records_.pop_front();
  }
  /// A frame ends at a time, whether there is a record of that time or not.
  void pass(TimeNs time) {
    if (stamps_.last() && *stamps_.last() < time) stamps_.miss();
  }
  /// Whether the sensor need not be waited for, to have its records up to a time: it has sent them,
  /// or has stopped, or is too slow.
  bool has_reached(TimeNs time, TimeNs longest_step) const {
    if (!stamps_.last()) return true;
    const TimeNs gap = time - *stamps_.last();
    return gap <= 0 || stamps_.has_stopped(time) ||
           stamps_.usual_step().value_or(0) >= longest_step;
  }
  /// The time of the first record at `until` or later; that of the last one if there is none.
  TimeNs end_of(TimeNs until) const {
    const auto at = std::lower_bound(records_.begin(), records_.end(), until,
                                     [](const Record& r, TimeNs time) { return r.time < time; });
    if (at != records_.end()) return at->time;
    return records_.empty() ? until : records_.back().time;
  }
  const std::deque<Record>& records() const { return records_; }
  bool empty() const { return records_.empty(); }

 private:
  static constexpr std::size_t kMost = 1 << 16;  // a minute of a fast IMU
  std::deque<Record> records_;
  SensorStamps stamps_;
};

}  // namespace fovea
