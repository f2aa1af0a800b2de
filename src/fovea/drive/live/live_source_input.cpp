// What sensors call.
#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "fovea/core/errors.h"
#include "fovea/drive/drive_files.h"
#include "fovea/drive/live/live_source_impl.h"

namespace fovea {
namespace {

/// Scans that the beginning keeps beyond the first ones, until it has their images.
constexpr std::size_t kMoreScans = 4;

/// s between the records of navigation that a frame waits for. Of a slower sensor, a frame takes
/// the motion up to the last record, unless the sender waits.
constexpr double kLongestStep = 0.03, kAnyStep = 60;

std::vector<std::string> names_of(const LiveSensors& sensors) {
  std::vector<std::string> names;
  names.reserve(sensors.size());
  for (std::size_t i = 0; i < sensors.size(); ++i) names.push_back(sensors.name(i));
  return names;
}

/// With the delays of cameras that an earlier run has found.
DriveDescription description_of(std::string_view drive_toml, const LiveOptions& options) {
  DriveDescription description = parse_drive_description(drive_toml, "drive.toml");
  for (CameraDescription& camera : description.cameras) {
    const auto found = options.image_delays.find(camera.index);
    if (found != options.image_delays.end()) camera.stamp_delay = found->second - camera.delay;
  }
  return description;
}

/// ConfigError for cameras that the drive lacks, and for options out of range.
void check(const DriveDescription& description, const LiveOptions& options) {
  if (options.first_scans < 1 || options.max_scans < 1) {
    throw ConfigError("a live drive needs a scan", "first_scans or max_scans", "give 1 or more");
  }
  constexpr double kLongest = 1e6;  // s
  const auto is_time = [](double wait) { return wait >= 0 && wait <= kLongest; };
  if (!is_time(options.max_wait) || !is_time(options.longest_beginning)) {
    throw ConfigError("a wait is no time", "max_wait or longest_beginning",
                      "give 0 to 1,000,000 s");
  }
  if (!options.drive.use_images || options.drive.cameras.empty()) return;
  choose_cameras(camera_numbers(description), options.drive, options.name);
}

}  // namespace

LiveSource::Impl::Impl(std::string_view drive_toml, const LiveOptions& options)
    : options_(options),
      description_(description_of(drive_toml, options)),
      queue_(description_.further_lidars.size(), description_.cameras.size(), first_limits()),
      motion_(description_, options.drive, options.name,
              options.waits ? kAnyStep : std::min(options.max_wait, kLongestStep)),
      watch_(names_of(sensors_)),
      clocks_(names_of(sensors_), !options.waits),
      next_index_(options.first_frame) {
  check(description_, options_);
  if (!options_.record.empty()) {
    recorder_.emplace(options_.record, std::string(drive_toml),
                      parse_drive_description(drive_toml, "drive.toml"));
  }
}

LiveSource::Impl::~Impl() {
  close();
  std::unique_lock lock(guard_);
  changed_.wait(lock, [&] { return callers_ == 0; });
}

void LiveSource::Impl::add_scan(LiveScan scan) {
  const std::optional<std::size_t> further = find_further_lidar(scan.lidar);
  const TimeNs arrival = wall_clock_now();
  std::unique_lock lock(guard_);
  const auto has_room = [&] {
    return further ? queue_.has_room_for_further_scan(*further) : queue_.has_room_for_scan();
  };
  if (!wait_for_room(lock, has_room)) return;
  ++figures_.scans;
  const std::size_t sensor = further ? sensors_.further_lidar(*further) : LiveSensors::kLidar;
  const std::optional<TimeNs> time = clocks_.time_of(sensor, scan.stamp, arrival);
  if (!time) {
    ++figures_.scans_out_of_order;
    return;
  }
  scan.stamp = *time;
  watch_.add(sensor, scan.stamp);
  auto shared = std::make_shared<const LiveScan>(std::move(scan));
  const WallClock::time_point now = WallClock::now();
  if (!further && !first_arrival_) first_arrival_ = now;
  const FrameQueue::Added added = further ? queue_.add_further_scan(*further, std::move(shared))
                                          : queue_.add_scan(std::move(shared), now);
  figures_.scans_out_of_order += added == FrameQueue::Added::kOutOfOrder ? 1 : 0;
  notify();
}

void LiveSource::Impl::add_image(LiveImage image) {
  const std::size_t camera = find_camera(image.camera);
  const TimeNs arrival = wall_clock_now();
  std::unique_lock lock(guard_);
  if (!wait_for_room(lock, [&] { return queue_.has_room_for_image(camera); })) return;
  ++figures_.images;
  if (!options_.drive.use_images) return;
  const std::optional<TimeNs> time = clocks_.time_of(sensors_.camera(camera), image.stamp, arrival);
  if (!time) {
    ++figures_.images_late;
    return;
  }
  image.stamp = *time;
  watch_.add(sensors_.camera(camera), image.stamp);
  const FrameQueue::Added added =
      queue_.add_image(camera, std::make_shared<const LiveImage>(std::move(image)));
  figures_.images_late += added == FrameQueue::Added::kLate ? 1 : 0;
  notify();
}

void LiveSource::Impl::close() {
  const std::lock_guard lock(guard_);
  closed_ = true;
  notify();
}

FrameQueueLimits LiveSource::Impl::first_limits() const {
  FrameQueueLimits limits;
  limits.scans = std::max(options_.first_scans + kMoreScans, options_.max_scans);
  return limits;
}

std::optional<std::size_t> LiveSource::Impl::find_further_lidar(const std::string& name) const {
  if (name.empty() || name == description_.lidar.name) return std::nullopt;
  const auto& further = description_.further_lidars;
  const auto found = std::find_if(further.begin(), further.end(),
                                  [&](const LidarDescription& l) { return l.name == name; });
  if (found != further.end()) return std::size_t(found - further.begin());
  throw std::invalid_argument(fmt::format("the drive has no LiDAR '{}'", name));
}

std::size_t LiveSource::Impl::find_camera(const std::string& name) const {
  const auto& cameras = description_.cameras;
  const auto found = std::find_if(cameras.begin(), cameras.end(),
                                  [&](const CameraDescription& c) { return c.name == name; });
  if (found != cameras.end()) return std::size_t(found - cameras.begin());
  throw std::invalid_argument(fmt::format("the drive has no camera '{}'", name));
}

void LiveSource::Impl::notify() {
  ++version_;
  changed_.notify_all();
}

template <class HasRoom>
bool LiveSource::Impl::wait_for_room(std::unique_lock<std::mutex>& lock, HasRoom&& has_room) {
  if (!options_.waits) return !closed_;
  ++callers_;
  const auto deadline = [&] { return WallClock::now() + wall_time(options_.max_wait); };
  auto end = deadline();
  while (!closed_ && !has_room()) {
    if (!queue_.scans().empty()) {
      if (options_.has_one_sender && !std::exchange(is_stuck_, true)) notify();
      changed_.wait(lock);
      end = deadline();
    } else if (options_.has_one_sender ||
               changed_.wait_until(lock, end) == std::cv_status::timeout) {
      break;
    }
  }
  --callers_;
  if (closed_) changed_.notify_all();
  return !closed_;
}

}  // namespace fovea
