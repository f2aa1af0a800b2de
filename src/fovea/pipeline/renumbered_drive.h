// A drive under other numbers of its frames.
#pragma once

#include <map>
#include <memory>
#include <optional>

#include "fovea/sensor/frame_source.h"

namespace fovea {

/// A drive that has only some of its frames, under other numbers.
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
