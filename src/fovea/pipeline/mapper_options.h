// Everything a map depends on besides its drive.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "fovea/mapping/foveal_region.h"
#include "fovea/mapping/ground.h"
#include "fovea/mapping/ray_filter.h"
#include "fovea/mapping/registration/local_map.h"
#include "fovea/mapping/registration/registration.h"
#include "fovea/mapping/surface.h"
#include "fovea/mapping/texture.h"
#include "fovea/mapping/upsample.h"
#include "fovea/pipeline/dynamic_points.h"
#include "fovea/pipeline/fusion.h"

namespace fovea {

/// What a scan is registered against.
enum class RegistrationTarget {
  kPreviousScan,  ///< the paper: pairwise, drifts
  kLocalMap,      ///< our default: recent scans within reach (docs/method.md 2.5)
};

/// Pose refinement (paper: Pose Refinement; docs/method.md 2).
struct RefinementOptions {
  RegistrationTarget target = RegistrationTarget::kLocalMap;
  bool visible_only = false;  ///< register only points that a camera sees (the paper's 0xUp..3xUp)
  int upsample_rate = 0;      ///< constrained upsampling of the non-ground points, 0-5
  double max_edge = 0.3;      ///< m, tau of that upsampling; set by upsample.max_edge
  double voxel = 0.25;        ///< m, at most one registered point a voxel; 0: no thinning
  /// A result further than this from the first guess has failed: the guess is kept and said so.
  double max_correction_translation = 2.0;               ///< m
  double max_correction_rotation = 0.08726646259971647;  ///< rad
  GroundOptions ground{.sensor_height = 0};              ///< height 0: that of the LiDAR's profile
  double range_noise = 0.02;                             ///< m, of the LiDAR; no key
  /// With a robust kernel, so that what moves does not pull (the paper has none), and a limit to
  /// the points: what more of them would add is less than what their errors have in common.
  RegistrationOptions registration{
      .method = RegistrationMethod::kPointToPlane, .max_points = 12000, .robust_width = 0.1};
  LocalMapOptions local_map;
  void validate() const;  ///< ConfigError that names the field
};

struct MapperOptions {
  /// Share of a drive's frames that may be damaged, 0 to 1.
  double max_damaged_share = 0.5;
  bool compensate_motion = true;  ///< sweep motion, where the drive's scans are raw
  /// Navigation at a scan's own stamp; false (ablation): the record nearest in time.
  bool interpolate_navigation = true;
  RefinementOptions refinement;
  /// False (baselines): no foveal region; every point is kept, and what no camera sees is
  /// uncoloured.
  bool foveal_enabled = true;
  FovealOptions foveal;
  /// Slices of single cameras by number, in place of foveal.slices.
  std::map<int, std::vector<AngularSlice>> camera_slices;
  /// Edges of 0 follow from the LiDAR's rings (pipeline/drive_sensors.h).
  SurfaceOptions surface{.max_edge = 0, .planar_edge = 0};
  UpsampleOptions upsample;  ///< where surface.spacing is 0, as in the paper
  RayFilterOptions ray_filter{.mode = RayFilterMode::kScan};
  TextureOptions texture{.views = TextureViews::kMean};
  DynamicPointOptions moving;
  FusionOptions fusion;
  bool check_calibration = true;  ///< look at edges of a few frames (pipeline/self_calibration.h)
  double tile_size = 4.0;         ///< m
  void validate() const;          ///< ConfigError that names the field
};

/// The foveal region of a camera, with slices of its own where it has any; of lidar_views()
/// (kNoCamera) without slices.
FovealOptions foveal_options_of(const MapperOptions& options, int camera);

/// The rows of the paper's Table II: "baseline-gicp", "baseline-icp", "baseline-plane",
/// "E0".."E11".
const std::vector<std::string>& variant_names();

/// Options of a row (docs/method.md 2): every row sets all that Table II compares, so that a row is
/// one change; what it does not set (ground, tau, tiles, ...) stays as in `options`. ConfigError
/// for an unknown name.
void apply_variant(std::string_view name, MapperOptions& options);

}  // namespace fovea
