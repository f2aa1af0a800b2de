// Frames on their way to the map: decoding of the next one, tracking of this one and, by whoever
// takes them here, mapping of the one before, side by side on the threads of the parallel loops
// (docs/performance.md). At a rate, where it counts how long a frame takes and not how many there
// are, who takes them tracks them too, and a sensor's thread waits for the next one.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <stop_token>

#include "fovea/base/idle_gate.h"
#include "fovea/base/prefetch.h"
#include "fovea/base/producer.h"
#include "fovea/base/wall_clock.h"
#include "fovea/pipeline/incremental_mapper.h"
#include "fovea/sensor/frame_source.h"

namespace fovea {

struct FramePipelineOptions {
  /// Frames a second that a live sensor would give; 0: as fast as they are wanted.
  double rate = 0;
  bool overlap = true;        ///< false: one after the other, all in the thread that takes them
  std::stop_token stop = {};  ///< ends after the frames that tracking has begun
  /// Called by whoever tracks before the next frame is there: what nobody waits for.
  std::function<void()> settle = [] {};
  /// Knows of each frame from its arrival until its taker has done with it. At a rate decoding
  /// leaves the processors to such frames while there is time.
  std::shared_ptr<IdleGate> gate = std::make_shared<IdleGate>();
};

/// A frame that has been tracked, or was skipped.
struct LocatedFrame {
  using TimePoint = WallClock::time_point;
  LoadedFrame result;
  std::optional<TrackedScan> tracked;  ///< absent: skipped
  /// When the frame could be tracked: at a rate, when it was due, be it decoded or not; otherwise
  /// when it was decoded and tracking took it, since a drive's files arrive as they are wanted.
  TimePoint arrival;
  TimePoint tracking_began, tracking_ended;
  double decode_ms = 0;  ///< wall time of reading and decoding
};

class FramePipeline {
 public:
  /// @param source  must outlive the pipeline
  /// @param indices  of the frames, in order
  /// @param track   called for each usable frame in order, in one thread at a time
  FramePipeline(const FrameSource& source, std::vector<int> indices,
                std::function<TrackedScan(const Frame&)> track,
                const FramePipelineOptions& options);

  /// The next frame, in order; nothing at the end. Errors of decoding and tracking come when all
  /// frames before have been taken. Who asks has done with the frame before.
  std::optional<LocatedFrame> next();

 private:
  using TimePoint = WallClock::time_point;
  struct Arrived {
    LoadedFrame result;
    double decode_ms;
    std::optional<TimePoint> due;
  };
  void expect_until(std::size_t place);
  std::optional<Arrived> arrive(const std::stop_token& stop);
  std::optional<LocatedFrame> locate();
  WallClock::duration periods(double count) const;

  const FrameSource& source_;
  std::vector<int> indices_;
  std::size_t next_ = 0;      // place in indices_
  std::size_t expected_ = 1;  // first place of which the source has not been told
  std::function<TrackedScan(const Frame&)> track_;
  FramePipelineOptions options_;
  TimePoint first_arrival_;
  bool taken_ = false;                                      // whether the taker has a frame
  Producer<Arrived> sensed_;                                // at a rate
  std::stop_callback<std::function<void()>> stop_sensing_;  // nobody waits for a frame not due yet
  Prefetch<Arrived> decoded_;                               // without
  Prefetch<LocatedFrame> located_;
};

}  // namespace fovea
