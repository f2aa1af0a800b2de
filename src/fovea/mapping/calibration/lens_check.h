// Whether the images fit the focal length and the distortion that the calibration states.
#pragma once

#include <vector>

#include "fovea/mapping/calibration/edge_profiles.h"

namespace fovea {

/// Errors of focal length and distortion that no correction of the extrinsics explains.
struct LensCheck {
  bool is_checked = false;  ///< there are enough edges
  /// Share by which the true focal length is longer.
  double focal = 0, focal_sigma = 0;
  /// Share by which the corner of the image lies farther out than the focal length says.
  double radial = 0, radial_sigma = 0;

  bool has_odd_focal() const { return is_checked && is_odd(focal, focal_sigma); }
  bool has_odd_distortion() const { return is_checked && is_odd(radial, radial_sigma); }

 private:
  static bool is_odd(double value, double sigma);
};

/// Fits focal length, radial distortion and the calibration to the edges.
/// @param camera  of the profiles, with its extrinsics estimated already
LensCheck check_lens(const std::vector<EdgeProfile>& profiles, const Camera& camera);

}  // namespace fovea
