// A drive with other frame numbers.
#pragma once

#include <map>
#include <memory>
#include <optional>

#include "fovea/drive/frame_source.h"

namespace fovea {

/// Some frames of a drive, with other numbers.
class RenumberedDrive : public FrameSource {
 public:
  /// @param number_in_drive  by the new number
  RenumberedDrive(std::unique_ptr<FrameSource> drive, std::map<int, int> number_in_drive);

  const DriveInfo& info() const override { return info_; }
  LoadedFrame load(int index) const override;
  void expect(int index) const override;
  std::optional<TimeNs> stamp(int index) const override;

 private:
  std::unique_ptr<FrameSource> drive_;
  std::map<int, int> number_in_drive_;
  DriveInfo info_;
};

}  // namespace fovea
