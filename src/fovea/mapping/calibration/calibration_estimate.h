// The calibration that aligns a LiDAR's edges with an image's edges (after Levinson, Thrun:
// Automatic Online Calibration of Cameras and Lasers, RSS 2013; docs/calibration.md).
#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include "fovea/mapping/calibration/edge_profiles.h"

namespace fovea {

/// Correction of a camera's calibration.
struct CalibrationEstimate {
  CameraCorrection correction;  ///< 0 in values that are not observable
  /// Standard deviations, from the scatter over frames and over objects. Meaningless for values
  /// that are not observable.
  CameraCorrection sigma;
  std::array<bool, kCalibrationSize> observable{};  ///< by CalibrationParameter
  /// Median displacement of the edges in the image by rotation and delay, and its standard
  /// deviation.
  double pixels = 0, pixels_sigma = 0;
  /// There are many edges, but no correction in range aligns those of the images and of the LiDAR.
  /// Then nothing is observable.
  bool disagrees = false;
  int frames = 0;  ///< with edges
  std::size_t edges = 0;

  bool is_any_observable() const {
    return std::find(observable.begin(), observable.end(), true) != observable.end();
  }
  bool rotation_observable() const { return observable[0] && observable[1] && observable[2]; }
  bool delay_observable() const { return observable[kCamDelay]; }
  /// Whether edges are off by over a pixel and by over three standard deviations.
  bool off_by_a_pixel() const { return pixels > 1 && pixels > 3 * pixels_sigma; }
};

/// Estimates rotation and delay from the profiles of several frames, in the order of the frames.
/// Rotation and delay are unobservable if there are too few edges or the images do not show them;
/// the delay also if the vehicle stands. A correction of over a pixel counts only if each half of
/// the frames confirms that of the other half.
CalibrationEstimate estimate_calibration(const std::vector<EdgeProfile>& profiles);

}  // namespace fovea
