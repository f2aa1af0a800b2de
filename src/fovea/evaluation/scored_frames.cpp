#include "fovea/evaluation/scored_frames.h"

#include <string>

namespace fovea {

std::variant<Frame, UnscoredFrame> load_scored_frame(const FrameSource& drive, int index) {
  const DriveInfo& info = drive.info();
  if (index < info.begin || index >= info.end) return UnscoredFrame{index, "not in the drive"};
  LoadedFrame loaded = drive.load(index);
  if (const auto* skipped = std::get_if<SkippedFrame>(&loaded)) {
    return UnscoredFrame{index, std::string(to_string(skipped->reason)) + ": " + skipped->detail};
  }
  return std::get<Frame>(std::move(loaded));
}

}  // namespace fovea
