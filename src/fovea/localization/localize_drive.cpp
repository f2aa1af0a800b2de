#include "fovea/localization/localize_drive.h"

#include <optional>
#include <utility>

#include "fovea/map/map_meta.h"
#include "fovea/pipeline/frame_reader.h"

namespace fovea {
namespace {

std::vector<int> wanted_frames(const DriveInfo& drive, const HoldOut& only) {
  std::vector<int> wanted;
  for (const int index : drive.frame_indices()) {
    if (only.none() || only.contains(index)) wanted.push_back(index);
  }
  return wanted;
}

}  // namespace

LocalizedDrive localize_drive(const FrameSource& drive, std::unique_ptr<SurfaceSource> source,
                              const LocalizationJob& job,
                              const std::function<void(int, int)>& progress) {
  const std::vector<int> wanted = wanted_frames(drive.info(), job.only);
  Localizer localizer(std::move(source), drive.info(), job.guess, job.options);
  FrameReader frames(drive, wanted, /*rate=*/0);
  int done = 0;
  FrameLocalization localization;
  localization.drive = drive.info().path.string();
  localization.localize = [&](const Frame& frame) { return localizer.localize(frame); };
  localization.stamp = [&](int index) { return drive.stamp(index); };
  localization.on_frame = [&](const Localization&) { progress(++done, int(wanted.size())); };
  return localize_frames(frames, localization);
}

std::vector<StampedPose> poses_in_local(std::vector<StampedPose> poses_drive,
                                        const GeodeticPoint& drive_origin,
                                        const GeodeticPoint& origin) {
  const RigidMotion T_local_drive = LocalTangentPlane(origin).T_local_enu(drive_origin);
  for (StampedPose& pose : poses_drive) pose.T_local_body = T_local_drive * pose.T_local_body;
  return poses_drive;
}

std::optional<Trajectory> navigation_in_local(const DriveInfo& drive, const GeodeticPoint& origin) {
  if (!drive.navigation || !drive.origin) return std::nullopt;
  return Trajectory(poses_in_local(drive.navigation->poses(), *drive.origin, origin));
}

std::optional<Trajectory> navigation_in_map(const DriveInfo& drive, const MapMeta& map) {
  const std::optional<GeodeticPoint> origin = map_origin(map);
  return origin ? navigation_in_local(drive, *origin) : std::nullopt;
}

}  // namespace fovea
