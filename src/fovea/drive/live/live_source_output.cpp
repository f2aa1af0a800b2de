// What the mapper calls.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "fovea/drive/drive_files.h"
#include "fovea/drive/live/live_source_impl.h"

namespace fovea {
namespace {

/// Of skipped frames, that the next frame gets.
constexpr TimeNs kSkippedMotion = 10 * kNsPerSecond;

/// Drops what is older than the last measurement of a sensor by more than a time.
void keep_last(MotionData& motion, TimeNs kept) {
  const auto old = [&](const auto& samples) {
    std::size_t count = 0;
    while (count < samples.size() && samples[count].time < samples.back().time - kept) ++count;
    return std::ptrdiff_t(count);
  };
  const std::ptrdiff_t poses = old(motion.poses);
  motion.poses.erase(motion.poses.begin(), motion.poses.begin() + poses);
  motion.accuracy.erase(motion.accuracy.begin(), motion.accuracy.begin() + poses);
  motion.imu.erase(motion.imu.begin(), motion.imu.begin() + old(motion.imu));
  motion.wheels.erase(motion.wheels.begin(), motion.wheels.begin() + old(motion.wheels));
}

}  // namespace

std::string LiveSource::Impl::missing() const {
  const std::lock_guard lock(guard_);
  if (decoder_) return {};
  return fmt::format("{}", fmt::join(missing_data(), ", "));
}

std::optional<Eigen::Vector3d> LiveSource::Impl::world_origin() const {
  const std::lock_guard lock(guard_);
  return motion_.frame().world;
}

LiveFigures LiveSource::Impl::figures() const {
  const std::lock_guard lock(guard_);
  LiveFigures figures = figures_;
  figures.append(motion_.messages());
  figures.append(clocks_.messages());
  figures.append(watch_.messages());
  figures.scans_dropped = queue_.scans_dropped();
  figures.scans_missing = queue_.scan_stamps().missing();
  for (std::size_t i = 0; i < description_.further_lidars.size(); ++i) {
    figures.scans_missing += queue_.further_scans(i).stamps().missing();
  }
  for (std::size_t i = 0; i < description_.cameras.size(); ++i) {
    figures.images_unused += queue_.images(i).unused();
    figures.images_missing += queue_.images(i).stamps().missing();
  }
  return figures;
}

template <class IsDone>
bool LiveSource::Impl::wait(std::unique_lock<std::mutex>& lock, const std::stop_token& stop,
                            std::optional<WallClock::time_point> end, IsDone&& is_done) {
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

std::optional<WallClock::time_point> LiveSource::Impl::end_of_wait(WallClock::time_point begin,
                                                                   double longest) const {
  if (options_.waits && options_.has_one_sender) return std::nullopt;
  return begin + wall_time(longest);
}

std::vector<std::string> LiveSource::Impl::missing_data() const {
  std::vector<std::string> missing;
  if (queue_.scans().size() < options_.first_scans) {
    missing.push_back(queue_.scans().empty()
                          ? "scans"
                          : fmt::format("{} of {} scans",
                                        options_.first_scans - queue_.scans().size(),
                                        options_.first_scans));
  }
  for (std::size_t i = 0; i < description_.further_lidars.size(); ++i) {
    if (!queue_.further_scans(i).items().empty()) continue;
    missing.push_back("scans of LiDAR " + description_.further_lidars[i].name);
  }
  add_missing_images(missing);
  if (options_.expects_navigation && options_.drive.use_navigation && !motion_.has_navigation()) {
    missing.emplace_back("poses or positions");
  }
  if (options_.drive.use_imu && description_.imu && !motion_.has_inertia()) {
    missing.emplace_back("records of the IMU");
  }
  return missing;
}

void LiveSource::Impl::add_missing_images(std::vector<std::string>& missing) const {
  if (!options_.drive.use_images || description_.cameras.empty()) return;
  const std::vector<int> all = camera_numbers(description_);
  const std::vector<int> chosen = choose_cameras(all, options_.drive, options_.name);
  for (std::size_t i = 0; i < all.size(); ++i) {
    const bool is_used = std::find(chosen.begin(), chosen.end(), all[i]) != chosen.end();
    if (!is_used || has_image_of_first_scans(i)) continue;
    missing.push_back("images of camera " + description_.cameras[i].name);
  }
}

bool LiveSource::Impl::has_image_of_first_scans(std::size_t camera) const {
  const auto& images = queue_.images(camera).items();
  if (images.empty() || queue_.scans().empty()) return false;
  const std::size_t last = std::min(options_.first_scans, queue_.scans().size()) - 1;
  return images.front()->stamp <= queue_.scans()[last].scan->stamp;
}

FirstData LiveSource::Impl::first_data() const {
  FirstData first;
  for (const FrameQueue::PendingScan& pending : queue_.scans()) {
    if (first.scans.size() < options_.first_scans) first.scans.push_back(pending.scan);
  }
  for (std::size_t i = 0; i < description_.further_lidars.size(); ++i) {
    const auto& items = queue_.further_scans(i).items();
    first.further_scans.emplace_back(items.begin(), items.end());
  }
  for (std::size_t i = 0; i < description_.cameras.size(); ++i) {
    const auto& items = queue_.images(i).items();
    first.images.emplace_back(items.begin(), items.end());
  }
  return first;
}

std::unique_ptr<FrameSource> LiveSource::Impl::begin(const std::stop_token& stop) {
  std::unique_lock lock(guard_);
  if (!wait(lock, stop, std::nullopt, [&] { return first_arrival_ || closed_; })) return nullptr;
  if (!first_arrival_) return nullptr;
  const auto end = end_of_wait(*first_arrival_, options_.longest_beginning);
  const auto has_all = [&] { return missing_data().empty() || closed_ || is_stuck_; };
  if (!wait(lock, stop, end, has_all)) return nullptr;
  const FirstData first = first_data();
  lock.unlock();
  LiveBeginning beginning = find_sensors(description_, options_.drive, options_.name, first);
  lock.lock();
  decoder_ = std::make_shared<const LiveDecoder>(beginning.decoder);
  used_cameras_ = beginning.sensors.cameras;
  queue_.use(beginning.sensors, first_limits().scans);
  std::vector<RawFrame> frames;
  while (frames.size() < first.scans.size()) {
    std::optional<RawFrame> raw = take_frame(lock, stop);
    if (!raw && stop.stop_requested()) return nullptr;
    if (!raw) break;
    frames.push_back(std::move(*raw));
  }
  queue_.use(beginning.sensors, options_.max_scans);
  for (const LiveCamera& camera : decoder_->cameras) {
    if (recorder_) recorder_->set_stamp_delay(camera.name, camera.usual_delay);
  }
  const LocalFrame local{0, options_.origin, options_.world_origin};
  add_first_frames(frames, description_, motion_, local, beginning);
  first_frames_.assign(frames.begin(), frames.end());
  begin_watch(beginning);
  notify();
  return first_frames_source(std::move(beginning.info), decoder_, std::move(frames));
}

std::optional<RawFrame> LiveSource::Impl::take_frame(std::unique_lock<std::mutex>& lock,
                                                     const std::stop_token& stop) {
  const auto has_scan = [&] { return !queue_.scans().empty(); };
  if (!wait(lock, stop, std::nullopt, [&] { return has_scan() || closed_; })) return std::nullopt;
  if (!has_scan()) return std::nullopt;
  // The oldest scan may be dropped meanwhile. The one after it then waits as long as this one.
  const auto end = end_of_wait(queue_.scans().front().arrival, options_.max_wait);
  const auto is_complete = [&] {
    const TimeNs stamp = queue_.scans().front().scan->stamp;
    return closed_ || is_stuck_ || (queue_.is_complete() && motion_.reaches(end_of_sweep(stamp)));
  };
  if (!wait(lock, stop, end, is_complete)) return std::nullopt;
  RawFrame raw = queue_.take();
  raw.index = next_index_++;
  is_stuck_ = false;
  motion_.pass(end_of_sweep(raw.stamp));
  notify();
  return raw;
}

void LiveSource::Impl::begin_watch(const LiveBeginning& beginning) {
  const DriveInfo& info = beginning.info;
  std::vector<bool> is_used(sensors_.size()), is_wanted(sensors_.size());
  is_used[LiveSensors::kLidar] = true;
  for (std::size_t i = 0; i < description_.further_lidars.size(); ++i) {
    is_wanted[sensors_.further_lidar(i)] = true;
  }
  for (const std::size_t i : beginning.sensors.further_lidars) {
    is_used[sensors_.further_lidar(i)] = true;
  }
  const std::vector<int> numbers = camera_numbers(description_), chosen = options_.drive.cameras;
  const auto has = [](const std::vector<int>& cameras, int camera) {
    return std::find(cameras.begin(), cameras.end(), camera) != cameras.end();
  };
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    is_wanted[sensors_.camera(i)] = options_.drive.use_images &&
                                    has(chosen.empty() ? numbers : chosen, numbers[i]) &&
                                    !has(info.unused_cameras, numbers[i]);
  }
  for (const std::size_t i : used_cameras_) is_used[sensors_.camera(i)] = true;
  const bool by_poses = motion_.is_by_poses();
  is_used[sensors_.poses()] = info.navigation && by_poses;
  is_used[sensors_.positions()] = info.navigation && !by_poses;
  is_used[sensors_.imu()] = info.imu.has_value();
  is_used[sensors_.wheels()] = info.wheels.has_value();
  is_wanted[sensors_.poses()] = options_.drive.use_navigation && !info.navigation;
  is_wanted[sensors_.positions()] = is_wanted[sensors_.poses()];
  is_wanted[sensors_.imu()] = options_.drive.use_imu && description_.imu;
  is_wanted[sensors_.wheels()] = options_.drive.use_imu;
  watch_.begin(is_used, is_wanted);
}

void LiveSource::Impl::finish_recording() {
  if (!recorder_) return;
  std::unique_lock lock(guard_);
  RawMotion unrecorded = std::exchange(unrecorded_, {});
  lock.unlock();
  recorder_->finish(std::move(unrecorded));
}

void LiveSource::Impl::add_motion_to(RawFrame& raw) {
  raw.motion = std::exchange(skipped_motion_, {});
  const MotionData data = motion_.take(end_of_sweep(raw.stamp));
  const auto append = [](auto& to, const auto& from) {
    to.insert(to.end(), from.begin(), from.end());
  };
  append(raw.motion.poses, data.poses);
  append(raw.motion.accuracy, data.accuracy);
  append(raw.motion.imu, data.imu);
  append(raw.motion.wheels, data.wheels);
}

std::optional<LiveFrame> LiveSource::Impl::next(const std::stop_token& stop) {
  std::unique_lock lock(guard_);
  if (!decoder_) throw std::logic_error("begin() comes before next()");
  if (stop.stop_requested()) return std::nullopt;
  RawFrame raw;
  if (!first_frames_.empty()) {
    raw = std::move(first_frames_.front());
    first_frames_.pop_front();
  } else {
    std::optional<RawFrame> taken = take_frame(lock, stop);
    if (!taken) return std::nullopt;
    raw = std::move(*taken);
    add_motion_to(raw);
  }
  const std::shared_ptr<const LiveDecoder> decoder = decoder_;
  RawMotion unrecorded = std::exchange(unrecorded_, {});
  lock.unlock();
  if (recorder_) recorder_->add(raw, std::move(unrecorded));
  const WallClock::time_point start = WallClock::now();
  LiveFrame frame{decoder->decode(raw), raw.arrival, 0};
  frame.decode_ms = milliseconds_since(start);
  if (std::holds_alternative<SkippedFrame>(frame.frame)) {
    skipped_motion_ = std::move(raw.motion);
    keep_last(skipped_motion_, kSkippedMotion);
  }
  return frame;
}

}  // namespace fovea
