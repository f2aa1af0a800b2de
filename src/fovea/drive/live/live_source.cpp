// The threads of a live source: what sensors call, and what the mapper calls.
#include "fovea/drive/live/live_source.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <deque>
#include <mutex>
#include <stdexcept>
#include <utility>
#include <vector>

#include "fovea/drive/drive_files.h"
#include "fovea/drive/live/first_frames.h"
#include "fovea/drive/live/live_input.h"
#include "fovea/drive/live/live_recorder.h"
#include "fovea/drive/live/live_waits.h"
#include "fovea/errors.h"

namespace fovea {
namespace {

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

TimeNs wall_clock_now() {
  return std::chrono::nanoseconds(WallClock::now().time_since_epoch()).count();
}

}  // namespace

struct LiveSource::Impl {
  Impl(std::string_view drive_toml, const LiveOptions& live_options)
      : options(live_options),
        description(description_of(drive_toml, options)),
        waits(options),
        input(description, options),
        next_index(options.first_frame) {
    check(description, options);
    if (options.record.empty()) return;
    recorder.emplace(options.record, std::string(drive_toml),
                     parse_drive_description(drive_toml, "drive.toml"));
  }

  template <class Record>
  void add_motion(std::size_t sensor, const Record& record) {
    const TimeNs arrival = wall_clock_now();
    const std::lock_guard lock(guard);
    if (waits.is_closed()) return;
    const std::optional<Record> used = input.add_motion(sensor, record, arrival);
    if (used && recorder) unrecorded.add(*used);
    waits.notify();
  }

  /// Waits until the oldest scan is a frame; nothing at the end.
  std::optional<RawFrame> take_frame(LiveWaits::Lock& lock, const std::stop_token& stop);

  const LiveOptions options;
  const DriveDescription description;

  mutable std::mutex guard;  // of all below
  LiveWaits waits;
  LiveInput input;
  int next_index;
  std::shared_ptr<const LiveDecoder> decoder;  // from begin() on
  std::deque<RawFrame> first_frames;           // that next() has not returned
  std::optional<LiveRecorder> recorder;        // for the thread that maps
  RawMotion unrecorded;
};

LiveSource::LiveSource(std::string_view drive_toml, const LiveOptions& options)
    : impl_(std::make_unique<Impl>(drive_toml, options)) {}

LiveSource::~LiveSource() {
  close();
  LiveWaits::Lock lock(impl_->guard);
  impl_->waits.wait_for_senders(lock);
}

void LiveSource::add_scan(LiveScan scan) {
  Impl& my = *impl_;
  const auto further = LiveSensors(my.description).find_further_lidar(scan.lidar);
  const TimeNs arrival = wall_clock_now();
  LiveWaits::Lock lock(my.guard);
  const auto has_room = [&] { return my.input.has_room_for_scan(further); };
  if (!my.waits.wait_for_room(lock, has_room, [&] { return my.input.has_scan(); })) return;
  my.input.add_scan(further, std::move(scan), arrival);
  my.waits.notify();
}

void LiveSource::add_image(LiveImage image) {
  Impl& my = *impl_;
  const std::size_t camera = LiveSensors(my.description).find_camera(image.camera);
  const TimeNs arrival = wall_clock_now();
  LiveWaits::Lock lock(my.guard);
  const auto has_room = [&] { return my.input.has_room_for_image(camera); };
  if (!my.waits.wait_for_room(lock, has_room, [&] { return my.input.has_scan(); })) return;
  my.input.add_image(camera, std::move(image), arrival);
  my.waits.notify();
}

void LiveSource::add_pose(const RecordedPose& pose) {
  impl_->add_motion(LiveSensors(impl_->description).poses(), pose);
}
void LiveSource::add_position(const RecordedPosition& position) {
  impl_->add_motion(LiveSensors(impl_->description).positions(), position);
}
void LiveSource::add_inertia(const RecordedInertia& inertia) {
  impl_->add_motion(LiveSensors(impl_->description).imu(), inertia);
}
void LiveSource::add_wheel_speed(const WheelSpeed& speed) {
  impl_->add_motion(LiveSensors(impl_->description).wheels(), speed);
}

void LiveSource::close() {
  const std::lock_guard lock(impl_->guard);
  impl_->waits.close();
}

std::unique_ptr<FrameSource> LiveSource::begin(const std::stop_token& stop) {
  Impl& my = *impl_;
  LiveWaits::Lock lock(my.guard);
  const std::optional<WallClock::time_point>& first_arrival = my.input.first_arrival();
  const auto has_begun = [&] { return first_arrival || my.waits.is_closed(); };
  if (!my.waits.wait(lock, stop, std::nullopt, has_begun) || !first_arrival) return nullptr;
  const auto end = my.waits.end_of_wait(*first_arrival, my.options.longest_beginning);
  const auto has_all = [&] { return my.input.missing().empty() || my.waits.is_over(); };
  if (!my.waits.wait(lock, stop, end, has_all)) return nullptr;
  const FirstData first = my.input.first_data();
  lock.unlock();
  LiveBeginning beginning = find_sensors(my.description, my.options.drive, my.options.name, first);
  lock.lock();
  my.decoder = std::make_shared<const LiveDecoder>(beginning.decoder);
  my.input.use(beginning);
  std::vector<RawFrame> frames;
  while (frames.size() < first.scans.size()) {
    std::optional<RawFrame> raw = my.take_frame(lock, stop);
    if (!raw && stop.stop_requested()) return nullptr;
    if (!raw) break;
    frames.push_back(std::move(*raw));
  }
  for (const LiveCamera& camera : my.decoder->cameras) {
    if (my.recorder) my.recorder->set_stamp_delay(camera.name, camera.usual_delay);
  }
  my.input.begin(frames, beginning);
  my.first_frames.assign(frames.begin(), frames.end());
  my.waits.notify();
  return first_frames_source(std::move(beginning.info), my.decoder, std::move(frames));
}

std::optional<RawFrame> LiveSource::Impl::take_frame(LiveWaits::Lock& lock,
                                                     const std::stop_token& stop) {
  const auto has_begun = [&] { return input.has_scan() || waits.is_closed(); };
  if (!waits.wait(lock, stop, std::nullopt, has_begun)) return std::nullopt;
  if (!input.has_scan()) return std::nullopt;
  // The oldest scan may be dropped meanwhile. The one after it then waits as long as this one.
  const auto end = waits.end_of_wait(input.oldest_arrival(), options.max_wait);
  const auto is_complete = [&] { return waits.is_over() || input.is_frame_complete(); };
  if (!waits.wait(lock, stop, end, is_complete)) return std::nullopt;
  RawFrame raw = input.take_frame();
  raw.index = next_index++;
  waits.notify_room();
  return raw;
}

std::optional<LiveFrame> LiveSource::next(const std::stop_token& stop) {
  Impl& my = *impl_;
  LiveWaits::Lock lock(my.guard);
  if (!my.decoder) throw std::logic_error("begin() comes before next()");
  if (stop.stop_requested()) return std::nullopt;
  RawFrame raw;
  if (!my.first_frames.empty()) {
    raw = std::move(my.first_frames.front());
    my.first_frames.pop_front();
  } else {
    std::optional<RawFrame> taken = my.take_frame(lock, stop);
    if (!taken) return std::nullopt;
    raw = std::move(*taken);
    raw.motion = my.input.take_motion(raw);
  }
  RawMotion unrecorded = std::exchange(my.unrecorded, {});
  lock.unlock();
  if (my.recorder) my.recorder->add(raw, std::move(unrecorded));
  const WallClock::time_point start = WallClock::now();
  LiveFrame frame{my.decoder->decode(raw), raw.arrival, 0};
  frame.decode_ms = milliseconds_since(start);
  if (std::holds_alternative<SkippedFrame>(frame.frame)) {
    lock.lock();
    my.input.give_back(std::move(raw.motion));
  }
  return frame;
}

std::string LiveSource::missing() const {
  const std::lock_guard lock(impl_->guard);
  if (impl_->decoder) return {};
  return fmt::format("{}", fmt::join(impl_->input.missing(), ", "));
}

std::optional<Eigen::Vector3d> LiveSource::world_origin() const {
  const std::lock_guard lock(impl_->guard);
  return impl_->input.local_frame().world;
}

LiveFigures LiveSource::figures() const {
  const std::lock_guard lock(impl_->guard);
  return impl_->input.figures();
}

void LiveSource::finish_recording() {
  if (!impl_->recorder) return;
  LiveWaits::Lock lock(impl_->guard);
  RawMotion unrecorded = std::exchange(impl_->unrecorded, {});
  lock.unlock();
  impl_->recorder->finish(std::move(unrecorded));
}

}  // namespace fovea
