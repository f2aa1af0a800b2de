#include "fovea/sensor/frame_source.h"

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

}  // namespace fovea
