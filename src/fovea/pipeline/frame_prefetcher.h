// Reads one frame ahead, so that decoding overlaps mapping.
#pragma once

#include <chrono>
#include <future>

#include "fovea/sensor/frame_source.h"

namespace fovea {

struct LoadedFrame {
  FrameResult result;
  double milliseconds = 0;  ///< wall time of reading and decoding
};

class FramePrefetcher {
 public:
  /// @param source  must outlive the prefetcher
  FramePrefetcher(const FrameSource& source, int begin, int end)
      : source_(source), next_(begin), end_(end) {
    prefetch();
  }
  /// The next frame of the range, in order.
  LoadedFrame take() {
    LoadedFrame frame = pending_.get();
    prefetch();
    return frame;
  }

 private:
  void prefetch() {
    if (next_ == end_) return;
    pending_ = std::async(std::launch::async, [this, index = next_++] {
      const auto start = std::chrono::steady_clock::now();
      FrameResult result = source_.load(index);
      const std::chrono::duration<double, std::milli> elapsed =
          std::chrono::steady_clock::now() - start;
      return LoadedFrame{std::move(result), elapsed.count()};
    });
  }
  const FrameSource& source_;
  int next_, end_;
  std::future<LoadedFrame> pending_;
};

}  // namespace fovea
