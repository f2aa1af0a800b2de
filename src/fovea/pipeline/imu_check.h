// Checks the mount and the clock of an IMU while a drive is mapped (docs/calibration.md).
#pragma once

#include <vector>

#include "fovea/map/frame_record.h"
#include "fovea/mapping/calibration/imu_hand_eye.h"
#include "fovea/pipeline/scan_track.h"

namespace fovea {

/// Collects the poses of a map, for an estimate at the end.
class ImuCheck {
 public:
  /// Largest number of used frames, from the first one on: keeps the cost small for drives of any
  /// length.
  static constexpr std::size_t kFrames = 1200;

  void add(const FrameRecord& record);
  ImuHandEye estimate(const ImuData& imu) const;

 private:
  std::vector<TrackedPose> poses_;
};

}  // namespace fovea
