// Checks and corrects the calibration from the drive itself: connects frames to mapping/calibration
// (docs/calibration.md).
#pragma once

#include <functional>
#include <optional>
#include <stop_token>
#include <vector>

#include "fovea/drive/frame_source.h"
#include "fovea/mapping/calibration/calibration_estimate.h"
#include "fovea/mapping/calibration/lidar_edges.h"
#include "fovea/pipeline/frame_motion.h"

namespace fovea {

struct CameraCalibration {
  int camera = 0;  ///< its number in the drive
  CalibrationEstimate estimate;
};

/// The edges that each LiDAR sees, in the LiDAR frame (find_lidar_edges).
/// @param scan_lidar  without motion compensation
std::vector<LidarEdges> edges_by_lidar(const PointCloud& scan_lidar, const Camera& camera,
                                       const DriveInfo& drive, double max_range);

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
  /// One estimate for each camera, in the calibration's order.
  std::vector<CameraCalibration> estimates() const;

 private:
  const DriveInfo& drive_;
  bool compensate_;
  int stride_, next_;
  std::vector<std::vector<EdgeProfile>> profiles_;  ///< by camera
};

struct CalibrationJob {
  bool compensate = true;  ///< as above
  /// Whether a frame may be used; held-out frames must not.
  std::function<bool(int index)> usable;
  /// Motion at a frame; frames without it are skipped.
  std::function<std::optional<FrameMotion>(int index)> motion;
  std::stop_token stop;  ///< ends early, with unusable estimates
};

/// Estimates from up to 60 frames over the whole drive, twice: the second time from the first
/// result. Unobservable parameters keep their values. Each estimate is the whole correction;
/// `pixels` is the displacement of edges before it.
std::vector<CameraCalibration> calibrate(const FrameSource& source, const CalibrationJob& job);

/// The calibration with the estimates applied to its cameras, in the same order.
Calibration corrected(const Calibration& calibration, const std::vector<CameraCalibration>& found);

}  // namespace fovea
