// The calibration checked and corrected by the drive itself: glue between frames and
// mapping/calibration (docs/calibration.md).
#pragma once

#include <functional>
#include <optional>
#include <stop_token>
#include <vector>

#include "fovea/mapping/calibration/calibration_estimate.h"
#include "fovea/pipeline/frame_motion.h"
#include "fovea/sensor/frame_source.h"

namespace fovea {

struct CameraCalibration {
  int camera = 0;  ///< the drive's number for it
  CalibrationEstimate estimate;
};

/// Gathers the edges of a few frames of a drive while it is mapped, for an estimate at the end.
class CalibrationCheck {
 public:
  /// Frames looked at, at most, and the frames from one to the next, at least: a small share of a
  /// drive's time, however long or short it is.
  static constexpr int kFrames = 20, kMinStride = 2;

  /// @param drive       must outlive the check
  /// @param compensate  whether the sweep's motion has to be taken out of scans
  CalibrationCheck(const DriveInfo& drive, bool compensate);

  /// Whether enough of the drive has passed since the last frame that was added.
  bool wants(int index) const { return index >= next_; }
  void add(const Frame& frame, const FrameMotion& motion);
  /// One a camera, in the calibration's order.
  std::vector<CameraCalibration> estimates() const;

 private:
  const DriveInfo& drive_;
  bool compensate_;
  int stride_, next_;
  std::vector<std::vector<EdgeProfile>> profiles_;  ///< by camera
};

struct CalibrationJob {
  bool compensate = true;  ///< as above
  /// Whether a frame may be looked at: held-out frames must not.
  std::function<bool(int index)> usable;
  /// At a frame; one without is left out.
  std::function<std::optional<FrameMotion>(int index)> motion;
  std::stop_token stop;  ///< ends early, with estimates of no use
};

/// Estimates from up to 60 frames spread over the drive, twice: the second time round the first
/// result. What is not observable is left as the drive's calibration has it. Each estimate is the
/// whole correction, `pixels` by how much edges lay off before it.
std::vector<CameraCalibration> calibrate(const FrameSource& source, const CalibrationJob& job);

/// The calibration with the estimates applied to its cameras, which are in the same order.
Calibration corrected(const Calibration& calibration, const std::vector<CameraCalibration>& found);

}  // namespace fovea
