// Options of the paper's method.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "fovea/foveal_region.h"
#include "fovea/ground.h"
#include "fovea/mapping/registration/registration.h"
#include "fovea/ray_filter.h"
#include "fovea/texture.h"
#include "fovea/upsample.h"

namespace fovea {

struct PaperOptions {
  /// Ground points are not upsampled for registration. Height 0: from the LiDAR's profile.
  GroundOptions ground{.sensor_height = 0};
  /// E6, the best row of Table II.
  RegistrationMethod registration = RegistrationMethod::kPointToPoint;
  /// Rate and tau, for the points to register and for the foveal points.
  UpsampleOptions upsample;
  /// False: a baseline of Table II. Whole scans are registered and kept, without ray filter.
  bool foveal_enabled = true;
  FovealOptions foveal{.far_range = 15};
  RayFilterOptions ray_filter;
  ImageSampling sampling = ImageSampling::kBilinear;
  double tile_size = 4.0;  ///< m
};

/// The rows of the paper's Table II: "baseline-gicp", "baseline-icp", "baseline-plane",
/// "E0".."E11".
const std::vector<std::string>& variant_names();

/// Sets what Table II compares: method, upsampling, foveal region and ray filter. Other options
/// stay as they are. ConfigError for an unknown name.
void apply_variant(std::string_view name, PaperOptions& options);

}  // namespace fovea
