// The frames of a stream localized one after the other.
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "fovea/core/messages.h"
#include "fovea/localization/localizer.h"
#include "fovea/pipeline/frame_stream.h"
#include "fovea/pipeline/map_summary.h"

namespace fovea {

struct LocalizedDrive : Messages {
  /// Of every frame of the drive's range that was asked for, in order.
  std::vector<Localization> frames;
  double frames_per_second = 0;
  double peak_rss_mb = 0;
  /// "decode": the scan; "localize"; "frame": both, as if one waited for the other, or of a live
  /// sensor the time from the arrival of the scan.
  std::map<std::string, StageLatency> latency_ms;

  int count(LocalizationState state) const;
  int found() const;  ///< times that the place was found anew
};

/// What localizes the frames of a stream. All are called by the thread of localize_frames().
struct FrameLocalization {
  std::string drive;  ///< for messages
  std::function<Localization(const Frame&)> localize;
  /// Time of a frame without a scan, if it has one.
  std::function<std::optional<TimeNs>(int index)> stamp;
  std::function<void(const Localization&)> on_frame;  ///< after each frame
};

/// Reads one frame ahead. InputError if no frame has a scan.
LocalizedDrive localize_frames(FrameStream& frames, const FrameLocalization& localization);

}  // namespace fovea
