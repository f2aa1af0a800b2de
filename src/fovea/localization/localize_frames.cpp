#include "fovea/localization/localize_frames.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "fovea/core/bounded_queue.h"
#include "fovea/core/process_memory.h"
#include "fovea/core/thread.h"
#include "fovea/core/wall_clock.h"
#include "fovea/errors.h"

namespace fovea {
namespace {

/// Localizes frames and measures the time that they take.
class LocalizationRun {
 public:
  explicit LocalizationRun(const FrameLocalization& localization) : localization_(localization) {}

  void add(const ReadFrame& read) {
    if (const auto* frame = std::get_if<Frame>(&read.result)) {
      localize(*frame, read);
    } else {
      skip(std::get<SkippedFrame>(read.result));
    }
    localization_.on_frame(localized_.frames.back());
  }

  LocalizedDrive finish() {
    const std::size_t scans = times_["frame"].size();
    if (scans == 0) {
      throw InputError(skipped_ ? fmt::format("no frame has a scan (the first: {})", *skipped_)
                                : "no frame was asked for",
                       localization_.drive, "choose other frames");
    }
    if (skipped_) {
      localized_.warn(fmt::format("{} frames without a scan (the first: {})",
                                  localized_.count(LocalizationState::kSkipped), *skipped_));
    }
    localized_.frames_per_second = 1000 * double(scans) / milliseconds_since(start_);
    localized_.peak_rss_mb = double(peak_resident_memory()) / (1 << 20);
    for (auto& [stage, milliseconds] : times_) {
      if (!milliseconds.empty()) localized_.latency_ms[stage] = latency_of(std::move(milliseconds));
    }
    return std::move(localized_);
  }

 private:
  void localize(const Frame& frame, const ReadFrame& read) {
    const auto began = WallClock::now();
    localized_.frames.push_back(localization_.localize(frame));
    const double took = milliseconds_since(began);
    times_["decode"].push_back(float(read.decode_ms));
    times_["localize"].push_back(float(took));
    times_["frame"].push_back(
        float(read.due ? milliseconds_since(*read.due) : read.decode_ms + took));
  }

  void skip(const SkippedFrame& frame) {
    if (!skipped_) skipped_ = frame.detail;
    Localization& none = localized_.frames.emplace_back();
    none.index = frame.index;
    none.stamp = localization_.stamp(frame.index);
  }

  const FrameLocalization& localization_;
  const WallClock::time_point start_ = WallClock::now();
  LocalizedDrive localized_;
  std::map<std::string, std::vector<float>> times_;
  std::optional<std::string> skipped_;  // why, of the first frame without a scan
};

}  // namespace

int LocalizedDrive::count(LocalizationState state) const {
  return static_cast<int>(std::count_if(frames.begin(), frames.end(),
                                        [&](const Localization& f) { return f.state == state; }));
}

int LocalizedDrive::found() const {
  return static_cast<int>(
      std::count_if(frames.begin(), frames.end(), [](const Localization& f) { return f.found; }));
}

LocalizedDrive localize_frames(FrameStream& frames, const FrameLocalization& localization) {
  BoundedQueue<ReadFrame> read(/*capacity=*/1);
  const std::jthread reader = start_thread("fovea-read", [&](const std::stop_token& stop) {
    fill(read, stop, [&] { return frames.next(stop); });
  });
  LocalizationRun run(localization);
  while (const std::optional<ReadFrame> frame = read.pop()) run.add(*frame);
  return run.finish();
}

}  // namespace fovea
