// Motion that sensors other than the LiDAR measured, up to the present frame.
#pragma once

#include <optional>
#include <vector>

#include "fovea/drive/frame_source.h"

namespace fovea {

/// Of a drive from files, all of it from the beginning. Of a live drive, it grows with the frames,
/// and keeps the last minute. Navigation of a live drive may begin with any frame.
class MotionHistory {
 public:
  explicit MotionHistory(const DriveInfo& drive);
  MotionHistory(const MotionHistory&) = delete;
  MotionHistory& operator=(const MotionHistory&) = delete;

  /// Adds the data of a frame. Drops data of an IMU or wheels that the drive did not have at its
  /// beginning.
  void add(const MotionData& data);

  // Null if the drive lacks them; the addresses never change. Navigation of a live drive is empty
  // before it begins.
  const Trajectory* navigation() const { return navigation_ ? &*navigation_ : nullptr; }
  const ImuData* imu() const { return imu_ ? &*imu_ : nullptr; }
  const WheelData* wheels() const { return wheels_ ? &*wheels_ : nullptr; }
  /// Of each pose of the navigation, see DriveInfo::navigation_accuracy.
  const std::vector<double>& navigation_accuracy() const { return accuracy_; }

 private:
  std::optional<Trajectory> navigation_;
  std::vector<double> accuracy_;
  std::optional<ImuData> imu_;
  std::optional<WheelData> wheels_;
};

}  // namespace fovea
