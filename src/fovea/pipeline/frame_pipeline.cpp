#include "fovea/pipeline/frame_pipeline.h"

#include <utility>

#include "fovea/core/thread.h"

namespace fovea {
namespace {

/// Frames in each queue. More frames would only wait there.
constexpr std::size_t kQueued = 1;

}  // namespace

FramePipeline::FramePipeline(FramePipelineStages stages, bool threaded, const std::stop_token& stop)
    : stages_(std::move(stages)),
      threaded_(threaded),
      user_stop_(stop),
      read_(kQueued),
      tracked_(kQueued),
      reader_(threaded ? start_reader() : std::jthread()),
      tracker_(threaded ? start_tracker() : std::jthread()),
      stop_reading_(stop, [this] { reader_.request_stop(); }) {}

std::jthread FramePipeline::start_reader() {
  return start_thread("fovea-read", [this](const std::stop_token& thread_stop) {
    fill(read_, thread_stop, [&] { return stages_.read(thread_stop); });
  });
}

std::jthread FramePipeline::start_tracker() {
  return start_thread("fovea-track", [this](const std::stop_token& thread_stop) {
    fill(tracked_, thread_stop, [&] {
      stages_.apply_deferred();
      return track(read_.pop(thread_stop));
    });
  });
}

std::optional<TrackedFrame> FramePipeline::next() {
  if (threaded_) return tracked_.pop();
  stages_.apply_deferred();
  return track(stages_.read(user_stop_));
}

std::optional<TrackedFrame> FramePipeline::track(std::optional<ReadFrame> read) {
  if (!read || user_stop_.stop_requested()) return std::nullopt;
  TrackedFrame frame;
  frame.read = *std::move(read);
  frame.tracking_began = WallClock::now();
  if (const auto* usable = std::get_if<Frame>(&frame.read.result)) {
    frame.tracked = stages_.track(*usable);
  }
  frame.tracking_ended = WallClock::now();
  return frame;
}

}  // namespace fovea
