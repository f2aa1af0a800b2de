#include "fovea/drive/live/live_input.h"

#include <algorithm>
#include <utility>

#include "fovea/drive/live/first_frames.h"

namespace fovea {
namespace {

/// Scans that the beginning keeps beyond the first ones, until it has their images.
constexpr std::size_t kMoreScans = 4;

/// s between the records of navigation that a frame waits for. Of a slower sensor, a frame takes
/// the motion up to the last record, unless the sender waits.
constexpr double kLongestStep = 0.03, kAnyStep = 60;

FrameQueueLimits first_limits(const LiveOptions& options) {
  FrameQueueLimits limits;
  limits.scans = std::max(options.first_scans + kMoreScans, options.max_scans);
  return limits;
}

}  // namespace

LiveInput::LiveInput(const DriveDescription& description, const LiveOptions& options)
    : description_(description),
      options_(options),
      queue_(description.further_lidars.size(), description.cameras.size(), first_limits(options)),
      motion_(description, options.drive, options.name,
              options.waits ? kAnyStep : std::min(options.max_wait, kLongestStep)),
      watch_(sensors_.names()),
      clocks_(sensors_.names(), !options.waits) {}

void LiveInput::add_scan(std::optional<std::size_t> further, LiveScan scan, TimeNs arrival) {
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
}

void LiveInput::add_image(std::size_t camera, LiveImage image, TimeNs arrival) {
  ++figures_.images;
  if (!options_.drive.use_images) return;
  const std::size_t sensor = sensors_.camera(camera);
  const std::optional<TimeNs> time = clocks_.time_of(sensor, image.stamp, arrival);
  if (!time) {
    ++figures_.images_late;
    return;
  }
  image.stamp = *time;
  watch_.add(sensor, image.stamp);
  const FrameQueue::Added added =
      queue_.add_image(camera, std::make_shared<const LiveImage>(std::move(image)));
  figures_.images_late += added == FrameQueue::Added::kLate ? 1 : 0;
}

void LiveInput::use(const LiveBeginning& beginning) {
  queue_.use(beginning.sensors, first_limits(options_).scans);
  sweep_end_ = sweep_end(beginning.decoder);
}

void LiveInput::begin(std::span<const RawFrame> first_frames, LiveBeginning& beginning) {
  queue_.use(beginning.sensors, options_.max_scans);
  const LocalFrame local{0, options_.origin, options_.world_origin};
  add_first_frames(first_frames, description_, motion_, local, beginning);
  const SensorUse use =
      find_use(description_, options_.drive, beginning, motion_.navigation().is_by_poses());
  watch_.begin(use.is_used, use.is_wanted);
}

bool LiveInput::is_frame_complete() const {
  return queue_.is_complete() && motion_.reaches(end_of_sweep(queue_.scans().front().scan->stamp));
}

RawFrame LiveInput::take_frame() {
  RawFrame frame = queue_.take();
  motion_.pass(end_of_sweep(frame.stamp));
  return frame;
}

MotionData LiveInput::take_motion(const RawFrame& frame) {
  MotionData motion = motion_.take(frame.stamp, end_of_sweep(frame.stamp));
  if (motion.begins) {
    watch_.use(motion_.navigation().is_by_poses() ? sensors_.poses() : sensors_.positions(),
               frame.stamp);
  }
  return motion;
}

LiveFigures LiveInput::figures() const {
  LiveFigures figures = figures_;
  figures.append(motion_.navigation().messages());
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

}  // namespace fovea
