// The calibration that aligns a LiDAR's edges with an image's edges (after Levinson, Thrun:
// Automatic Online Calibration of Cameras and Lasers, RSS 2013; docs/calibration.md).
#pragma once

#include <vector>

#include "fovea/mapping/calibration/edge_profiles.h"

namespace fovea {

/// Correction of a camera's calibration: exp(rotation) * T_cam_lidar and image_delay + delay are
/// right.
struct CalibrationEstimate {
  Eigen::Vector3d rotation = Eigen::Vector3d::Zero();  ///< rad, in the camera's axes
  double delay = 0;                                    ///< s
  /// Standard deviations, from the scatter over frames and over objects. Meaningless for a quantity
  /// that is not observable, which is 0 above.
  Eigen::Vector3d rotation_sigma = Eigen::Vector3d::Zero();
  double delay_sigma = 0;
  bool rotation_observable = false, delay_observable = false;
  /// Median displacement of the edges in the image by rotation and delay, and its standard
  /// deviation.
  double pixels = 0, pixels_sigma = 0;
  /// Whether edges agree under the estimate, and it lies so far inside the search range that other
  /// frames find it too. Then fovea map --calibrate corrects the fault.
  bool correctable = false;
  /// There are many edges, but no correction in range aligns those of the images and of the LiDAR.
  /// Then nothing is observable.
  bool disagrees = false;
  int frames = 0;  ///< with edges
  std::size_t edges = 0;

  /// Whether edges are off by over a pixel and by over three standard deviations.
  bool off_by_a_pixel() const { return pixels > 1 && pixels > 3 * pixels_sigma; }
};

/// Estimates from the profiles of several frames, in the order of the frames. Rotation and delay
/// are unobservable if there are too few edges or the images do not show them; the delay also if
/// the vehicle stands. A correction of over a pixel counts only if each half of the frames confirms
/// that of the other half.
CalibrationEstimate estimate_calibration(const std::vector<EdgeProfile>& profiles);

/// The camera with the estimate's rotation and delay added to its own.
Camera corrected(const Camera& camera, const CalibrationEstimate& estimate);

}  // namespace fovea
