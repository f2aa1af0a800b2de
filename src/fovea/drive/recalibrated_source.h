// A drive with another calibration.
#pragma once

#include <memory>
#include <optional>
#include <utility>

#include "fovea/drive/frame_source.h"

namespace fovea {

/// The frames of a drive with another DriveInfo.
class RecalibratedSource : public FrameSource {
 public:
  /// @param info  that of `drive`, with another calibration
  RecalibratedSource(std::shared_ptr<const FrameSource> drive, DriveInfo info)
      : drive_(std::move(drive)), info_(std::move(info)) {}

  const DriveInfo& info() const override { return info_; }
  LoadedFrame load(int index) const override { return drive_->load(index); }
  void expect(int index) const override { drive_->expect(index); }
  std::optional<TimeNs> stamp(int index) const override { return drive_->stamp(index); }

 private:
  std::shared_ptr<const FrameSource> drive_;
  DriveInfo info_;
};

}  // namespace fovea
