#include "fovea/pipeline/run_meta.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "fovea/core/path_name.h"
#include "fovea/map/meta_keys.h"
#include "fovea/pipeline/config.h"
#include "fovea/platform.h"

namespace fovea {
namespace {

const char* to_string(PoseSource source) {
  switch (source) {
    case PoseSource::kRefine:
      return "refine";
    case PoseSource::kNavigation:
      return "navigation";
    case PoseSource::kGiven:
    case PoseSource::kGivenFirst:
      return "given";
  }
  return "unknown";
}

}  // namespace

MapMeta meta_of_run(const DriveInfo& drive, const MapJob& job) {
  MapMeta meta;
  meta[meta_key::kFoveaVersion] = version();
  meta[meta_key::kDriveName] = name_of(drive.path);
  meta[meta_key::kDriveKind] = drive.kind;
  std::vector<int> cameras;
  cameras.reserve(drive.calibration.cameras.size());
  for (const Camera& camera : drive.calibration.cameras) cameras.push_back(camera.index);
  meta[meta_key::kCameras] = fmt::format("{}", fmt::join(cameras, ","));
  std::vector<std::string> masks;
  masks.reserve(drive.masks.size());
  for (const auto& [camera, mask] : drive.masks) {
    masks.push_back(fmt::format("{}:{:08x}", camera, mask.fingerprint()));
  }
  if (!masks.empty()) meta[meta_key::kMasks] = fmt::format("{}", fmt::join(masks, ","));
  meta[meta_key::kFramesBegin] = fmt::format("{}", drive.begin);
  meta[meta_key::kFramesEnd] = fmt::format("{}", drive.end);
  meta[meta_key::kHoldOut] = job.hold_out.spec();
  meta[meta_key::kPoses] = to_string(job.pose_source);
  if (drive.imu) meta[meta_key::kImu] = drive.wheels ? "with wheels" : "used";
  meta[meta_key::kVariant] = job.variant;
  meta[meta_key::kCalibration] = job.calibrate ? "corrected" : "as given";
  meta[meta_key::kConfig] = to_toml(job.settings);
  meta[meta_key::kTileSize] = fmt::format("{}", job.settings.tile_size());
  set_origin(drive.origin, meta);
  meta[meta_key::kNotes] = fmt::format("{}", fmt::join(drive.notes, "\n"));
  return meta;
}

void set_origin(const std::optional<GeodeticPoint>& origin, MapMeta& meta) {
  meta[meta_key::kGeoreferenced] = fmt::to_string(origin ? 1 : 0);
  if (!origin) return;
  meta[meta_key::kOriginLatitude] = fmt::format("{}", origin->latitude);
  meta[meta_key::kOriginLongitude] = fmt::format("{}", origin->longitude);
  meta[meta_key::kOriginHeight] = fmt::format("{}", origin->altitude);
}

}  // namespace fovea
