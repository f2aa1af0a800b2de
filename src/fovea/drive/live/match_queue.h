// Data of a sensor that wait for the scan that they belong to.
#pragma once

#include <algorithm>
#include <cstdlib>
#include <deque>
#include <memory>
#include <optional>

#include "fovea/drive/live/sensor_stamps.h"
#include "fovea/time.h"

namespace fovea {

/// Images of a camera, or scans of a further LiDAR, in the order of their stamps. Each scan of the
/// first LiDAR takes the item that is nearest to its expected time, as match_nearest() does.
/// @tparam Item  has a stamp and content_bytes()
template <class Item>
class MatchQueue {
 public:
  using Pointer = std::shared_ptr<const Item>;

  /// @param item  with a later stamp than the one before
  void add(Pointer item) {
    stamps_.add(item->stamp);
    bytes_ += content_bytes(*item);
    items_.push_back(std::move(item));
  }

  /// An item that is not kept.
  /// @param is_late  its scan is a frame already
  void pass(TimeNs stamp, bool is_late) {
    stamps_.add(stamp);
    unused_ += is_late ? 0 : 1;
  }

  /// Whether no item that comes later can be nearer to a time than those at hand. A sensor with a
  /// steady rate shows that before its next item comes.
  bool is_decided(TimeNs time, TimeNs tolerance) const {
    if (!stamps_.last()) return false;
    const TimeNs gap = time - *stamps_.last();
    if (gap <= 0 || stamps_.has_stopped(time)) return true;
    const std::optional<TimeNs> step = stamps_.usual_step();
    if (!step) return false;
    if (gap <= tolerance) return 10 * gap < 3 * *step;
    return 10 * (*step - gap) > 10 * tolerance + 2 * *step;
  }

  /// Takes the item nearest to a time; nothing if none is within the tolerance, or if it is nearer
  /// to the time of the next scan, or belongs to the one before.
  Pointer take(TimeNs time, TimeNs tolerance, TimeNs next_time) {
    const auto away = [&](TimeNs stamp) { return std::abs(stamp - time); };
    Pointer taken;
    if (!items_.empty()) {
      const Pointer& nearest = items_[find_nearest(time)];
      const TimeNs stamp = nearest->stamp, distance = away(stamp);
      const bool is_before = last_taken_ && away(*last_taken_) <= distance;
      const bool is_next = std::abs(stamp - next_time) < distance;
      if (distance <= tolerance && !is_before && !is_next) taken = nearest;
    }
    if (taken) last_taken_ = taken->stamp;
    if (!taken) stamps_.miss();
    drop_until(std::max(time, last_taken_.value_or(time)));
    if (taken) --unused_;
    return taken;
  }

  /// Drops the oldest item.
  void drop_oldest() { drop(0); }
  void drop(std::size_t i) {
    bytes_ -= content_bytes(*items_[i]);
    items_.erase(items_.begin() + std::ptrdiff_t(i));
    ++unused_;
  }
  /// The item nearest to a time. The queue is not empty.
  std::size_t find_nearest(TimeNs time) const {
    const auto away = [&](const Pointer& item) { return std::abs(item->stamp - time); };
    const auto found =
        std::min_element(items_.begin(), items_.end(),
                         [&](const Pointer& a, const Pointer& b) { return away(a) < away(b); });
    return std::size_t(found - items_.begin());
  }

  const std::deque<Pointer>& items() const { return items_; }
  const SensorStamps& stamps() const { return stamps_; }
  std::size_t bytes() const { return bytes_; }
  /// Stamp of the last one that a scan has taken.
  const std::optional<TimeNs>& last_taken() const { return last_taken_; }
  /// Items that no scan has taken and none can take any more, but for those that were late.
  std::size_t unused() const { return unused_; }

 private:
  void drop_until(TimeNs time) {
    while (!items_.empty() && items_.front()->stamp <= time) drop_oldest();
  }

  std::deque<Pointer> items_;
  std::optional<TimeNs> last_taken_;
  SensorStamps stamps_;
  std::size_t unused_ = 0, bytes_ = 0;
};

}  // namespace fovea
