#include "fovea/pipeline/frame_pipeline.h"

#include <algorithm>
#include <utility>

namespace fovea {
namespace {

/// Frames that the decoding thread is ahead. More frames would only wait.
constexpr std::size_t kAhead = 1;
/// The source expects a frame this many frames ahead. A sleeping or busy disk may take a second.
constexpr std::size_t kExpected = 10;
/// With a rate, decoding waits until no frame is in work, but starts at the latest this long before
/// the frame is due. In periods.
constexpr double kInTime = 0.25;

/// @return false if `stop` ended the wait
bool wait_until(WallClock::time_point due, const std::stop_token& stop) {
  std::mutex guard;
  std::unique_lock lock(guard);
  std::condition_variable_any woken;
  woken.wait_until(lock, stop, due, [] { return false; });
  return !stop.stop_requested();
}

/// Whether the stages run on the threads of the parallel loops.
bool are_tasks(const FramePipelineOptions& options) { return options.overlap && options.rate == 0; }

}  // namespace

FramePipeline::FramePipeline(const FrameSource& source, std::vector<int> indices,
                             std::function<TrackedScan(const Frame&)> track,
                             const FramePipelineOptions& options)
    : source_(source),
      indices_(std::move(indices)),
      track_(std::move(track)),
      options_(options),
      sensed_(options.overlap && options.rate != 0 ? kAhead : 0,
              [this](const std::stop_token& stop) { return arrive(stop); }),
      stop_sensing_(options.stop, [this] { sensed_.stop(); }),
      decoded_(are_tasks(options), [this] { return arrive({}); }),
      located_(are_tasks(options), [this] { return locate(); }) {}

WallClock::duration FramePipeline::periods(double count) const {
  return std::chrono::duration_cast<WallClock::duration>(
      std::chrono::duration<double>(count / options_.rate));
}

std::optional<LocatedFrame> FramePipeline::next() {
  if (std::exchange(taken_, false)) options_.gate->end();
  std::optional<LocatedFrame> located = located_.next();
  taken_ = located.has_value();
  return located;
}

void FramePipeline::expect_until(std::size_t place) {
  for (; expected_ < std::min(place, indices_.size()); ++expected_) {
    source_.expect(indices_[expected_]);
  }
}

std::optional<FramePipeline::Arrived> FramePipeline::arrive(const std::stop_token& stop) {
  if (next_ == indices_.size()) return std::nullopt;
  const std::size_t place = next_++;
  const bool is_first = place == 0, at_rate = options_.rate != 0;
  expect_until(place + kExpected);
  std::optional<TimePoint> due;
  if (at_rate && !is_first) {
    due = first_arrival_ + periods(double(place));
    options_.gate->wait(*due - periods(kInTime), stop);
  }
  const TimePoint start = WallClock::now();
  LoadedFrame result = source_.load(indices_[place]);
  const TimePoint loaded = WallClock::now();
  if (at_rate && is_first) due = first_arrival_ = loaded;
  if (due && !wait_until(*due, stop)) return std::nullopt;
  options_.gate->begin();
  return Arrived{std::move(result), milliseconds(loaded - start), due};
}

std::optional<LocatedFrame> FramePipeline::locate() {
  options_.settle();
  std::optional<Arrived> arrived = options_.rate != 0 ? sensed_.next() : decoded_.next();
  if (!arrived || options_.stop.stop_requested()) return std::nullopt;
  LocatedFrame located;
  located.decode_ms = arrived->decode_ms;
  located.result = std::move(arrived->result);
  located.tracking_began = WallClock::now();
  located.arrival = arrived->due.value_or(located.tracking_began);
  if (const auto* frame = std::get_if<Frame>(&located.result)) located.tracked = track_(*frame);
  located.tracking_ended = WallClock::now();
  return located;
}

}  // namespace fovea
