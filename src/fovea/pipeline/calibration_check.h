// Checks the calibration while a drive is mapped (docs/calibration.md).
#pragma once

#include <vector>

#include "fovea/drive/frame_source.h"
#include "fovea/pipeline/drive_calibration.h"
#include "fovea/pipeline/frame_motion.h"

namespace fovea {

/// Collects edges of a few frames while a drive is mapped, for an estimate at the end.
class CalibrationCheck {
 public:
  /// Largest number of used frames, and least number of frames between two of them. Both keep the
  /// cost small for drives of any length.
  static constexpr int kFrames = 20, kMinStride = 2;

  /// @param drive       must outlive the check
  /// @param compensate  whether scans need motion compensation
  CalibrationCheck(const DriveInfo& drive, bool compensate);

  /// Whether enough frames have passed since the last added one.
  bool is_due(int index) const { return index >= next_; }
  void add(const Frame& frame, const FrameMotion& motion);
  /// Rotation and delay of each camera, in the calibration's order.
  std::vector<CameraCalibration> estimates() const;

 private:
  const DriveInfo& drive_;
  bool compensate_;
  int stride_, next_;
  std::vector<std::vector<EdgeProfile>> profiles_;  ///< by camera
};

}  // namespace fovea
