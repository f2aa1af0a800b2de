#include "fovea/drive/live/frame_queue.h"

#include <cstdlib>
#include <set>

namespace fovea {

FrameQueue::FrameQueue(std::size_t further_lidars, std::size_t cameras, FrameQueueLimits limits)
    : limits_(limits),
      further_(further_lidars),
      images_(cameras),
      further_places_(further_lidars),
      image_places_(cameras) {}

FrameQueue::Added FrameQueue::add_scan(ScanPointer scan, WallClock::time_point now) {
  if (scan_stamps_.last() && scan->stamp <= *scan_stamps_.last()) return Added::kOutOfOrder;
  scan_stamps_.add(scan->stamp);
  if (!has_room_for_scan()) {
    scans_.pop_front();
    ++scans_dropped_;
  }
  scans_.push_back({std::move(scan), now});
  return Added::kTaken;
}

template <class Item>
FrameQueue::Added FrameQueue::add(MatchQueue<Item>& queue, std::shared_ptr<const Item> item,
                                  const std::optional<ExpectedPlace>& place) {
  if (queue.stamps().last() && item->stamp <= *queue.stamps().last()) return Added::kOutOfOrder;
  if (sensors_ && !place) return Added::kTaken;  // not in use
  if (place && last_taken_) {
    const TimeNs expected = *last_taken_ + place->delay,
                 next = (scans_.empty() ? *last_taken_ + sensors_->period
                                        : scans_.front().scan->stamp) +
                        place->delay;
    const auto belongs = [&](TimeNs stamp) {
      const TimeNs away = std::abs(stamp - expected);
      return away <= place->tolerance && away <= std::abs(stamp - next);
    };
    const bool is_late =
        belongs(item->stamp) && !(queue.last_taken() && belongs(*queue.last_taken()));
    if (is_late || item->stamp <= expected) {
      queue.pass(item->stamp, is_late);
      return is_late ? Added::kLate : Added::kTaken;
    }
  }
  queue.add(std::move(item));
  return Added::kTaken;
}

FrameQueue::Added FrameQueue::add_further_scan(std::size_t lidar, ScanPointer scan) {
  MatchQueue<LiveScan>& queue = further_[lidar];
  const Added added = add(queue, std::move(scan), further_places_[lidar]);
  while (queue.items().size() > limits_.scans + 2) {
    queue.drop_oldest();
    ++scans_dropped_;
  }
  return added;
}

FrameQueue::Added FrameQueue::add_image(std::size_t camera, ImagePointer image) {
  const Added added = add(images_[camera], std::move(image), image_places_[camera]);
  trim_images(camera);
  return added;
}

bool FrameQueue::has_room_for_further_scan(std::size_t lidar) const {
  return further_[lidar].items().size() < limits_.scans + 2;
}

bool FrameQueue::has_room_for_image(std::size_t camera) const {
  const MatchQueue<LiveImage>& queue = images_[camera];
  const std::optional<TimeNs> last = queue.stamps().last(), scan = scan_stamps_.last();
  bool is_ahead = last && scan && *last - *scan > limits_.images;
  // Before the first scan, the first images wait for it.
  if (last && !scan && !queue.items().empty()) {
    is_ahead = *last - queue.items().front()->stamp > limits_.images / 2;
  }
  return !is_ahead && queue.items().size() < limits_.image_count &&
         queue.bytes() < limits_.image_bytes;
}

void FrameQueue::trim_images(std::size_t camera) {
  MatchQueue<LiveImage>& queue = images_[camera];
  const auto is_over = [&] {
    const auto& items = queue.items();
    if (items.size() <= 1) return false;
    const TimeNs first_scan = scans_.empty() ? items.back()->stamp : scans_.front().scan->stamp,
                 begin = std::min(items.back()->stamp, first_scan) - limits_.images;
    return items.front()->stamp < begin || items.size() > limits_.image_count ||
           queue.bytes() > limits_.image_bytes;
  };
  while (is_over()) {
    if (!drop_unneeded(camera)) queue.drop_oldest();
  }
}

bool FrameQueue::drop_unneeded(std::size_t camera) {
  const std::optional<ExpectedPlace>& place = image_places_[camera];
  if (!place || scans_.empty()) return false;
  MatchQueue<LiveImage>& queue = images_[camera];
  std::set<std::size_t> needed;
  for (const PendingScan& pending : scans_) {
    needed.insert(queue.find_nearest(pending.scan->stamp + place->delay));
  }
  const TimeNs last = scans_.back().scan->stamp + place->delay;
  for (std::size_t i = 0; i < queue.items().size() && queue.items()[i]->stamp < last; ++i) {
    if (needed.contains(i)) continue;
    queue.drop(i);
    return true;
  }
  return false;
}

void FrameQueue::use(Sensors sensors, std::size_t scan_limit) {
  limits_.scans = scan_limit;
  for (std::size_t i = 0; i < sensors.further_lidars.size(); ++i) {
    further_places_[sensors.further_lidars[i]] = sensors.further_places[i];
  }
  for (std::size_t i = 0; i < sensors.cameras.size(); ++i) {
    image_places_[sensors.cameras[i]] = sensors.image_places[i];
  }
  for (std::size_t i = 0; i < images_.size(); ++i) {
    while (!image_places_[i] && !images_[i].items().empty()) images_[i].drop_oldest();
  }
  for (std::size_t i = 0; i < further_.size(); ++i) {
    while (!further_places_[i] && !further_[i].items().empty()) further_[i].drop_oldest();
  }
  sensors_ = std::move(sensors);
}

TimeNs FrameQueue::next_stamp() const {
  if (scans_.size() > 1) return scans_[1].scan->stamp;
  return scans_.front().scan->stamp + scan_stamps_.usual_step().value_or(sensors_->period);
}

bool FrameQueue::is_complete() const {
  if (scans_.empty()) return false;
  const TimeNs stamp = scans_.front().scan->stamp;
  const auto is_decided = [&](const auto& queue, const ExpectedPlace& place) {
    return queue.is_decided(stamp + place.delay, place.tolerance);
  };
  for (std::size_t i = 0; i < sensors_->cameras.size(); ++i) {
    if (!is_decided(images_[sensors_->cameras[i]], sensors_->image_places[i])) return false;
  }
  for (std::size_t i = 0; i < sensors_->further_lidars.size(); ++i) {
    if (!is_decided(further_[sensors_->further_lidars[i]], sensors_->further_places[i])) {
      return false;
    }
  }
  return true;
}

RawFrame FrameQueue::take() {
  RawFrame frame;
  const TimeNs next = next_stamp();
  frame.scan = scans_.front().scan;
  frame.stamp = frame.scan->stamp;
  frame.arrival = scans_.front().arrival;
  scans_.pop_front();
  last_taken_ = frame.stamp;
  const auto take_from = [&](auto& queue, const ExpectedPlace& place) {
    return queue.take(frame.stamp + place.delay, place.tolerance, next + place.delay);
  };
  for (std::size_t i = 0; i < sensors_->cameras.size(); ++i) {
    frame.images.push_back(take_from(images_[sensors_->cameras[i]], sensors_->image_places[i]));
  }
  for (std::size_t i = 0; i < sensors_->further_lidars.size(); ++i) {
    frame.further_scans.push_back(
        take_from(further_[sensors_->further_lidars[i]], sensors_->further_places[i]));
  }
  return frame;
}

}  // namespace fovea
