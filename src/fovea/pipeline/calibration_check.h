// Checks the calibration while a drive is mapped (docs/calibration.md).
#pragma once

#include <optional>
#include <vector>

#include "fovea/drive/frame_source.h"
#include "fovea/pipeline/drive_calibration.h"
#include "fovea/pipeline/frame_motion.h"
#include "fovea/pipeline/imu_check.h"

namespace fovea {

/// Collects edges of a few frames and the poses of many while a drive is mapped, for an estimate
/// at the end.
class CalibrationCheck {
 public:
  /// Largest number of used frames, and least number of frames between two of them. Both keep the
  /// cost small for drives of any length.
  static constexpr int kFrames = 20, kMinStride = 2;

  /// @param drive       must outlive the check. A live drive has no measurements of the whole
  ///                    IMU, which is then not checked
  /// @param compensate  whether scans need motion compensation
  /// @param begin       first frame; absent: that of the drive
  CalibrationCheck(const DriveInfo& drive, bool compensate, bool is_live,
                   std::optional<int> begin = {});

  /// Whether enough frames have passed since the last one whose edges were added.
  bool is_due(int index) const { return !profiles_.empty() && index >= next_ && used_ < kFrames; }
  void add_edges(const Frame& frame, const FrameMotion& motion);
  void add_pose(const FrameRecord& record) {
    if (checks_imu_) imu_.add(record);
  }
  /// Rotation and delay of each camera, in the calibration's order, and of the IMU, if there is
  /// one.
  DriveCalibration estimate() const;

 private:
  const DriveInfo& drive_;
  bool compensate_;
  bool checks_imu_;
  int stride_, next_;
  int used_ = 0;                                    // frames whose edges were added
  std::vector<std::vector<EdgeProfile>> profiles_;  ///< by camera
  ImuCheck imu_;
};

}  // namespace fovea
