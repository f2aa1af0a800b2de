#include "fovea/drive/live/live_waits.h"

#include <chrono>
#include <utility>

namespace fovea {
namespace {

WallClock::duration wall_time(double seconds) {
  return std::chrono::duration_cast<WallClock::duration>(std::chrono::duration<double>(seconds));
}

}  // namespace

LiveWaits::LiveWaits(const LiveOptions& options)
    : senders_wait_(options.waits),
      has_one_sender_(options.has_one_sender),
      max_wait_(options.max_wait) {}

void LiveWaits::notify() {
  ++version_;
  changed_.notify_all();
}

void LiveWaits::notify_room() {
  is_stuck_ = false;
  notify();
}

void LiveWaits::close() {
  is_closed_ = true;
  notify();
}

bool LiveWaits::wait_for_room(Lock& lock, const Condition& has_room, const Condition& has_scan) {
  if (!senders_wait_) return !is_closed_;
  ++senders_;
  const auto deadline = [&] { return WallClock::now() + wall_time(max_wait_); };
  auto end = deadline();
  while (!is_closed_ && !has_room()) {
    if (has_scan()) {
      if (has_one_sender_ && !std::exchange(is_stuck_, true)) notify();
      changed_.wait(lock);
      end = deadline();
    } else if (has_one_sender_ || changed_.wait_until(lock, end) == std::cv_status::timeout) {
      break;
    }
  }
  --senders_;
  if (is_closed_) changed_.notify_all();
  return !is_closed_;
}

bool LiveWaits::wait(Lock& lock, const std::stop_token& stop,
                     std::optional<WallClock::time_point> end, const Condition& is_done) {
  while (!stop.stop_requested() && !is_done()) {
    const std::size_t seen = version_;
    const auto has_changed = [&] { return version_ != seen; };
    if (!end) {
      changed_.wait(lock, stop, has_changed);
    } else if (WallClock::now() >= *end) {
      break;
    } else {
      changed_.wait_until(lock, stop, *end, has_changed);
    }
  }
  return !stop.stop_requested();
}

void LiveWaits::wait_for_senders(Lock& lock) {
  changed_.wait(lock, [&] { return senders_ == 0; });
}

std::optional<WallClock::time_point> LiveWaits::end_of_wait(WallClock::time_point begin,
                                                            double longest) const {
  if (senders_wait_ && has_one_sender_) return std::nullopt;
  return begin + wall_time(longest);
}

}  // namespace fovea
