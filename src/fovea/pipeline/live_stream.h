// The frames of a live source as those of a run.
#pragma once

#include <functional>
#include <optional>
#include <stop_token>
#include <utility>

#include "fovea/drive/live/live_source.h"
#include "fovea/pipeline/frame_stream.h"
#include "fovea/pipeline/live_clocks.h"

namespace fovea {

class LiveStream : public FrameStream {
 public:
  /// @param clocks  correct the frames; or null
  explicit LiveStream(LiveSource& source, LiveClocks* clocks = nullptr)
      : source_(source), clocks_(clocks) {}

  std::optional<ReadFrame> next(const std::stop_token& stop) override {
    std::optional<LiveFrame> frame = source_.next(stop);
    if (!frame) return std::nullopt;
    auto* const usable = std::get_if<Frame>(&frame->frame);
    if (clocks_ != nullptr && usable != nullptr) clocks_->correct(*usable);
    return ReadFrame{std::move(frame->frame), frame->decode_ms, frame->arrival};
  }

 private:
  LiveSource& source_;
  LiveClocks* clocks_;
};

/// Closes a source at the end of a run, and at a stop if there is one: no thread waits to add data
/// that nothing reads.
class ClosedAtEnd {
 public:
  explicit ClosedAtEnd(LiveSource& source, const std::stop_token& stop = {})
      : source_(source), at_stop_(stop, [this] { source_.close(); }) {}
  ~ClosedAtEnd() { source_.close(); }
  ClosedAtEnd(const ClosedAtEnd&) = delete;
  ClosedAtEnd& operator=(const ClosedAtEnd&) = delete;

 private:
  LiveSource& source_;
  std::stop_callback<std::function<void()>> at_stop_;
};

}  // namespace fovea
