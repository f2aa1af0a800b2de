// The frames of a run, in order.
#pragma once

#include <optional>
#include <stop_token>

#include "fovea/core/wall_clock.h"
#include "fovea/drive/frame_source.h"

namespace fovea {

/// A frame in memory, or a skipped one.
struct ReadFrame {
  LoadedFrame result;
  double decode_ms = 0;  ///< wall time of reading and decoding
  /// When a live sensor would have delivered the frame; absent at full speed.
  std::optional<WallClock::time_point> due = {};
};

class FrameStream {
 public:
  virtual ~FrameStream() = default;
  /// The next frame; nothing at the end or if `stop` is requested. Throws the errors of
  /// FrameSource::load.
  virtual std::optional<ReadFrame> next(const std::stop_token& stop) = 0;
};

}  // namespace fovea
