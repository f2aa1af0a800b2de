// A whole drive localized in a map or a city.
#pragma once

#include <functional>
#include <map>
#include <memory>
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
/// @param source  of a map or a city
LocalizedDrive localize_drive(const FrameSource& drive, std::unique_ptr<SurfaceSource> source,
                              const LocalizationJob& job,
                              const std::function<void(int, int)>& progress);

/// Navigation as a guess; nothing if the drive has none, or has no georeference.
/// @param origin  of the local frame of the map or the city
std::optional<Trajectory> navigation_in_local(const DriveInfo& drive, const GeodeticPoint& origin);
/// The same in a map; nothing if the map has no georeference.
std::optional<Trajectory> navigation_in_map(const DriveInfo& drive, const MapMeta& map);

}  // namespace fovea
