#include "fovea/sensor/frame_source.h"

#include <fmt/format.h>

#include "fovea/base/errors.h"

namespace fovea {

const char* to_string(SkipReason reason) {
  switch (reason) {
    case SkipReason::kMissingScan:
      return "missing scan";
    case SkipReason::kDamagedScan:
      return "damaged scan";
    case SkipReason::kMissingImage:
      return "missing image";
    case SkipReason::kDamagedImage:
      return "damaged image";
    case SkipReason::kMissingStamp:
      return "missing time stamp";
  }
  return "unknown";
}

void require_cameras(const DriveInfo& drive, std::string_view purpose) {
  if (!drive.calibration.cameras.empty()) return;
  throw InputError(fmt::format("the drive has no camera, which {} needs", purpose),
                   drive.path.string(), "give a drive with images and their calibration");
}

}  // namespace fovea
