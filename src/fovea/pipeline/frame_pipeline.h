// Pipeline of frames: decoding, tracking, and the caller's mapping (docs/performance.md). Without a
// rate, the three stages run in parallel on the threads of the parallel loops. With a rate, the
// caller's thread also tracks, and another thread decodes: this shortens the time of one frame.
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
  /// Frames per second of the simulated live sensor; 0: no waiting.
  double rate = 0;
  bool overlap = true;        ///< false: all stages run in the caller's thread
  std::stop_token stop = {};  ///< ends after the frames that tracking has begun
  /// Deferred work; runs in the tracking thread before it waits for the next frame.
  std::function<void()> settle = [] {};
  /// Counts frames from their arrival to the end of their mapping. With a rate, decoding of the
  /// next frame waits for these frames while there is time.
  std::shared_ptr<IdleGate> gate = std::make_shared<IdleGate>();
};

/// A frame that has been tracked, or was skipped.
struct LocatedFrame {
  using TimePoint = WallClock::time_point;
  LoadedFrame result;
  std::optional<TrackedScan> tracked;  ///< absent: skipped
  /// With a rate, the time at which the frame was due; otherwise tracking_began.
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

  /// The next frame, in order; nothing at the end. Throws errors of decoding and tracking in the
  /// order of the frames. The call also ends the mapping of the frame before.
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
  std::size_t expected_ = 1;  // first place not yet passed to source_.expect()
  std::function<TrackedScan(const Frame&)> track_;
  FramePipelineOptions options_;
  TimePoint first_arrival_;
  bool taken_ = false;                                      // whether the caller has a frame
  Producer<Arrived> sensed_;                                // with a rate
  std::stop_callback<std::function<void()>> stop_sensing_;  // ends the wait for a frame
  Prefetch<Arrived> decoded_;                               // without a rate
  Prefetch<LocatedFrame> located_;
};

}  // namespace fovea
