// Reads and tracks the frames of a drive while the caller maps:
//
//   thread       work                          result goes to
//   fovea-read   FramePipelineStages::read     queue read_
//   fovea-track  FramePipelineStages::track    queue tracked_
//   the caller   next(), then mapping
//
// ARCHITECTURE.md has all threads of a run.
#pragma once

#include <functional>
#include <optional>
#include <stop_token>
#include <thread>

#include "fovea/core/bounded_queue.h"
#include "fovea/core/wall_clock.h"
#include "fovea/pipeline/frame_stream.h"
#include "fovea/pipeline/incremental_mapper.h"

namespace fovea {

/// A frame that has been tracked, or was skipped.
struct TrackedFrame {
  using TimePoint = WallClock::time_point;
  ReadFrame read;
  std::optional<TrackedScan> tracked;  ///< absent: skipped
  TimePoint tracking_began, tracking_ended;
  /// At a live sensor's rate, the time at which the frame was due. Otherwise tracking_began.
  TimePoint arrival() const { return read.due.value_or(tracking_began); }
};

struct FramePipelineStages {
  /// The next frame, in order; nothing at the end or if `stop` is requested.
  std::function<std::optional<ReadFrame>(const std::stop_token& stop)> read;
  /// Called for each usable frame, in order.
  std::function<TrackedScan(const Frame&)> track;
  /// Deferred work of the tracker. Called before the wait for a frame.
  std::function<void()> apply_deferred = [] {};
};

class FramePipeline {
 public:
  /// @param threaded  false: next() itself reads and tracks
  /// @param stop      ends reading. Frames that are tracked still come.
  FramePipeline(FramePipelineStages stages, bool threaded, const std::stop_token& stop);

  /// The next frame, in order; nothing at the end. Throws errors of reading and tracking in the
  /// order of the frames.
  std::optional<TrackedFrame> next();

 private:
  std::jthread start_reader();
  std::jthread start_tracker();
  std::optional<TrackedFrame> track(std::optional<ReadFrame> read);

  FramePipelineStages stages_;
  bool threaded_;
  std::stop_token user_stop_;
  BoundedQueue<ReadFrame> read_;
  BoundedQueue<TrackedFrame> tracked_;
  std::jthread reader_, tracker_;  // use all of the above; without threads, both are empty
  std::stop_callback<std::function<void()>> stop_reading_;
};

}  // namespace fovea
