// The calibration under which a LiDAR's edges lie on the image's (after Levinson, Thrun: Automatic
// Online Calibration of Cameras and Lasers, RSS 2013; docs/calibration.md).
#pragma once

#include <vector>

#include "fovea/mapping/calibration/edge_profiles.h"

namespace fovea {

/// What a camera's calibration lacks: exp(rotation) * T_cam_lidar and image_delay + delay are
/// right.
struct CalibrationEstimate {
  Eigen::Vector3d rotation = Eigen::Vector3d::Zero();  ///< rad, in the camera's axes
  double delay = 0;                                    ///< s
  /// Standard deviations, from the scatter over frames and over things. Where something is not
  /// observable, it is 0 above and means nothing here.
  Eigen::Vector3d rotation_sigma = Eigen::Vector3d::Zero();
  double delay_sigma = 0;
  bool rotation_observable = false, delay_observable = false;
  /// Median way of the edges in the image by rotation and delay, and its standard deviation.
  double pixels = 0, pixels_sigma = 0;
  /// Whether edges meet under the estimate, and it lies so far within the reach of the search that
  /// an estimate from other frames finds it, too: then fovea map --calibrate corrects the fault.
  bool correctable = false;
  /// There are many edges, but nothing within reach brings those of the images and those of the
  /// LiDAR together. Then nothing is observable.
  bool disagrees = false;
  int frames = 0;  ///< with edges
  std::size_t edges = 0;

  /// Whether edges lie off by over a pixel, and not by chance (three standard deviations).
  bool off_by_a_pixel() const { return pixels > 1 && pixels > 3 * pixels_sigma; }
};

/// Estimates from the profiles of several frames, one frame's after the other's. Too few of them,
/// or images that do not show them, leave both unobservable, a vehicle that stands the delay. A
/// correction of over a pixel counts only if either half of the frames confirms that of the other.
CalibrationEstimate estimate_calibration(const std::vector<EdgeProfile>& profiles);

/// The camera with the estimate's rotation and delay added to its own.
Camera corrected(const Camera& camera, const CalibrationEstimate& estimate);

}  // namespace fovea
