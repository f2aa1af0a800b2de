// A whole drive localized in a map or a city.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "fovea/drive/hold_out.h"
#include "fovea/localization/localize_frames.h"
#include "fovea/localization/localizer.h"

namespace fovea {

struct LocalizationJob {
  LocalizationGuess guess;
  LocalizerOptions options;
  HoldOut only;  ///< frames to localise; of none: all
};

/// `progress` is called after each frame with how many are done, of how many. InputError as
/// Localizer, or if no frame of the range has a scan.
/// @param drive  its images are not needed (DriveOptions::use_images)
/// @param source  of a map or a city
LocalizedDrive localize_drive(const FrameSource& drive, std::unique_ptr<SurfaceSource> source,
                              const LocalizationJob& job,
                              const std::function<void(int, int)>& progress);

/// Poses in the local frame of a drive, in the local frame of a map or a city.
/// @param drive_origin, origin  of these frames
std::vector<StampedPose> poses_in_local(std::vector<StampedPose> poses_drive,
                                        const GeodeticPoint& drive_origin,
                                        const GeodeticPoint& origin);

/// Navigation as a guess; nothing if the drive has none, or has no georeference.
/// @param origin  of the local frame of the map or the city
std::optional<Trajectory> navigation_in_local(const DriveInfo& drive, const GeodeticPoint& origin);
/// The same in a map; nothing if the map has no georeference.
std::optional<Trajectory> navigation_in_map(const DriveInfo& drive, const MapMeta& map);

}  // namespace fovea
