#include "fovea/localization/localize_live.h"

#include <utility>

#include "fovea/errors.h"
#include "fovea/localization/localize_drive.h"
#include "fovea/pipeline/live_stream.h"

namespace fovea {
namespace {

LocalizationGuess find_guess(const DriveInfo& drive, const LiveLocalizationJob& job) {
  LocalizationGuess guess;
  if (job.guess != LiveGuess::kFirst && job.map_origin) {
    guess.trajectory = navigation_in_local(drive, *job.map_origin);
  }
  if (job.guess == LiveGuess::kNavigation && !guess.trajectory) {
    throw InputError(
        "there is no navigation to guess by: it takes a robot with GPS/INS and a georeferenced map",
        drive.path.string(), "choose another guess");
  }
  if (job.guess == LiveGuess::kFirst) guess.first = job.first;
  return guess;
}

}  // namespace

LocalizedLive localize_live(LiveSource& source, std::unique_ptr<SurfaceSource> map,
                            const LiveLocalizationJob& job) {
  const ClosedAtEnd closed(source, job.stop);
  const std::unique_ptr<FrameSource> first_frames = source.begin({});
  if (!first_frames) {
    throw InputError("the live source ended before the first scan", "live source",
                     "see docs/live.md for what a drive needs");
  }
  const DriveInfo& drive = first_frames->info();
  const LocalizationGuess guess = find_guess(drive, job);
  const bool has_navigation = guess.trajectory.has_value();
  Localizer localizer(std::move(map), drive, guess, job.options);
  FrameLocalization localization;
  localization.drive = drive.path.string();
  localization.localize = [&](const Frame& frame) {
    if (has_navigation) {
      localizer.add_navigation(poses_in_local(frame.motion.poses, *drive.origin, *job.map_origin));
    }
    return localizer.localize(frame);
  };
  localization.stamp = [](int) -> std::optional<TimeNs> { return std::nullopt; };
  localization.on_frame = job.on_localized;
  LiveStream frames(source);
  LocalizedLive localized{localize_frames(frames, localization)};
  localized.guess = has_navigation ? LiveGuess::kNavigation : LiveGuess::kFirst;
  localized.append(drive);
  return localized;
}

}  // namespace fovea
