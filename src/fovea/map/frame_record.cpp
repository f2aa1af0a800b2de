#include "fovea/map/frame_record.h"

namespace fovea {

const char* to_string(FrameStatus status) {
  switch (status) {
    case FrameStatus::kMapped: return "mapped";
    case FrameStatus::kHeldOut: return "held-out";
    case FrameStatus::kSkipped: return "skipped";
  }
  return "unknown";
}

}  // namespace fovea
