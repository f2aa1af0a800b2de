// A drive for tests.
#pragma once

#include <optional>

#include "fovea/drive/frame_source.h"

namespace fovea {

/// Frames with an image of one camera; that of frame 8 is missing.
class TestDrive : public FrameSource {
 public:
  explicit TestDrive(int begin = 7, int end = 9) {
    Camera camera;
    camera.index = 3;
    camera.width = 8;
    camera.height = 4;
    camera.fx = camera.fy = 10;
    info_.calibration.cameras = {camera};
    info_.path = "test_drive";
    info_.begin = begin;
    info_.end = end;
  }
  const DriveInfo& info() const override { return info_; }
  LoadedFrame load(int index) const override {
    if (index == 8) return SkippedFrame{8, SkipReason::kMissingImage, "gone"};
    Frame frame;
    frame.index = index;
    frame.images = {Image(8, 4, 3)};
    return frame;
  }
  std::optional<TimeNs> stamp(int) const override { return std::nullopt; }

 private:
  DriveInfo info_;
};

}  // namespace fovea
