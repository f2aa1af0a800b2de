// A whole drive localised in a map.
#pragma once

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "fovea/core/messages.h"
#include "fovea/drive/hold_out.h"
#include "fovea/localization/localizer.h"
#include "fovea/pipeline/map_summary.h"

namespace fovea {

struct LocalizationJob {
  LocalizationGuess guess;
  LocalizerOptions options;
  HoldOut only;  ///< frames to localise; of none: all
};

struct LocalizedDrive : Messages {
  /// Of every frame of the drive's range that was asked for, in order.
  std::vector<Localization> frames;
  double frames_per_second = 0;
  double peak_rss_mb = 0;
  /// "decode": the scan; "localize"; "frame": both, as if one waited for the other.
  std::map<std::string, StageLatency> latency_ms;

  int count(LocalizationState state) const;
  int found() const;  ///< times that the place was found anew
};

/// `progress` is called after each frame with how many are done, of how many. InputError as
/// Localizer, or if no frame of the range has a scan.
/// @param drive  its images are not needed (DriveOptions::use_images)
LocalizedDrive localize_drive(const FrameSource& drive, const MapReader& map,
                              const LocalizationJob& job,
                              const std::function<void(int, int)>& progress);

/// Navigation as a guess; nothing if the drive has none, or drive or map do not tell where on earth
/// they are.
std::optional<Trajectory> navigation_in_map(const DriveInfo& drive, const MapMeta& map);

}  // namespace fovea
