// A live drive localized in a map or a city: each scan as it comes.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <stop_token>

#include "fovea/drive/live/live_source.h"
#include "fovea/localization/localize_frames.h"

namespace fovea {

/// Where the search for a live drive begins.
enum class LiveGuess {
  kAny,         ///< by navigation if the drive and the map have coordinates, or else as kFirst
  kNavigation,  ///< by navigation
  kFirst        ///< at the given place of the first scan, or anywhere
};

struct LiveLocalizationJob {
  LiveGuess guess = LiveGuess::kAny;
  /// With kFirst: see LocalizationGuess::first.
  std::optional<RigidMotion> first;
  /// Of the local frame of the map or the city, if it has coordinates.
  std::optional<GeodeticPoint> map_origin;
  LocalizerOptions options;
  /// After each frame, by the thread of localize_live().
  std::function<void(const Localization&)> on_localized = [](const Localization&) {};
  /// Closes the source. The frames that came before are localized.
  std::stop_token stop;
};

struct LocalizedLive : LocalizedDrive {
  LiveGuess guess = LiveGuess::kFirst;  ///< never kAny
};

/// Localizes the frames of a source until it is closed, and closes it. Its images are not needed
/// (DriveOptions::use_images). The poses are those of localize_drive() for the same frames.
///
/// No frame of the source is left out: a source without LiveOptions::waits drops scans if time is
/// short. In `latency_ms`, "frame" is from the arrival of a scan.
/// @param map  of a map or a city
/// @throws InputError  as Localizer; if the source is closed before the first scan; with
///                     kNavigation, if the drive or the map has no coordinates
LocalizedLive localize_live(LiveSource& source, std::unique_ptr<SurfaceSource> map,
                            const LiveLocalizationJob& job);

}  // namespace fovea
