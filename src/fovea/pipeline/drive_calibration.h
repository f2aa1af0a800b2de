// Estimates the calibration of a drive: of its cameras and its IMU against the LiDAR
// (docs/calibration.md).
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "fovea/drive/drive_correction.h"
#include "fovea/mapping/calibration/calibration_estimate.h"
#include "fovea/mapping/calibration/calibration_view.h"
#include "fovea/mapping/calibration/imu_hand_eye.h"
#include "fovea/mapping/calibration/lens_check.h"
#include "fovea/pipeline/scan_track.h"

namespace fovea {

struct DriveCalibrationJob {
  ScanTrackJob track;
  /// Whether the images of a frame may be used; those of held-out frames must not.
  std::function<bool(int index)> usable = [](int) { return true; };
  int overlays = 0;  ///< number of images of each camera to return with their LiDAR points
};

/// A LiDAR point in an image.
struct OverlayPoint {
  float u = 0, v = 0;    ///< pixels
  float range = 0;       ///< m, from the camera
  bool is_edge = false;  ///< the last point of an object, see LidarEdges
};

/// An image with the LiDAR's points, under the given and the corrected calibration.
struct CalibrationOverlay {
  int frame = 0;
  Image image;
  std::vector<OverlayPoint> before, after;
};

struct CameraCalibration {
  int camera = 0;  ///< its number in the drive
  CalibrationEstimate estimate;
  LensCheck lens = {};
  std::vector<CalibrationOverlay> overlays = {};
};

struct DriveCalibration {
  std::vector<CameraCalibration> cameras;  ///< in the order of the drive's
  std::optional<ImuHandEye> imu;           ///< absent without an IMU
  std::size_t frames = 0;                  ///< tracked
};

/// Tracks the scans of a drive, at most 1,200 from the first on, and estimates the calibration of
/// its IMU and its cameras. Reads the drive again from its folder. Poses come from the job, or from
/// registration with navigation if there is any. The IMU has no part in them until it is
/// calibrated.
/// @throws InputError  if no frame can be tracked
DriveCalibration calibrate_drive(const DriveInfo& drive, const DriveCalibrationJob& job);

/// The drive under the corrected calibration.
DriveInfo corrected(DriveInfo drive, const DriveCalibration& found);

/// The corrected calibration of a drive, for a file (write_calibrated_drive).
DriveCorrection correction_of(const DriveInfo& drive, const DriveCalibration& found);

}  // namespace fovea
