// A drive of frames without content, for tests of the pipeline.
#pragma once

#include <atomic>
#include <numeric>
#include <utility>
#include <vector>

#include "fovea/drive/frame_source.h"
#include "fovea/errors.h"

namespace fovea {

/// One frame is skipped, and one may be an error. One reader at a time.
class NumberedFrames : public FrameSource {
 public:
  static constexpr int kSkipped = 3;
  int error_at = -1;
  mutable std::atomic<int> loaded{0};
  mutable std::vector<std::pair<int, int>> expected;  // and the number loaded before

  const DriveInfo& info() const override { return info_; }
  std::optional<TimeNs> stamp(int index) const override { return index; }
  void expect(int index) const override { expected.emplace_back(index, loaded); }
  LoadedFrame load(int index) const override {
    ++loaded;
    if (index == error_at) throw InputError("no such frame", "numbers", "ask for another");
    if (index == kSkipped) return SkippedFrame{index, SkipReason::kMissingScan, ""};
    Frame frame;
    frame.index = index;
    return frame;
  }

 private:
  DriveInfo info_;
};

/// first, ..., end - 1.
inline std::vector<int> numbers(int first, int end) {
  std::vector<int> numbers(static_cast<std::size_t>(end - first));
  std::iota(numbers.begin(), numbers.end(), first);
  return numbers;
}

}  // namespace fovea
