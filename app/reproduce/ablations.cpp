#include "app/reproduce/ablations.h"

#include <algorithm>

namespace fovea::app {
namespace {

/// The paper's figure: a horizontal slice tilted down, and a vertical one.
constexpr const char* kSlices = "foveal.slices=[[-25, 25, -20, -10], [-5, 5, -25, 25]]";
constexpr const char* kHorizontalSlice = "foveal.slices=[[-25, 25, -20, -10]]";
/// Half of a camera of 81 degrees.
constexpr const char* kHalfView = "foveal.slices=[[-20, 20, -89, 89]]";

const char* const kParts = "Each part switched off";
const char* const kPoses = "Poses";
const char* const kZone = "White zone, slices, incidence";
const char* const kDensity = "Upsampling: rate and tau";
const char* const kFilter = "Ray filter: M and c";

}  // namespace

const std::vector<Ablation>& ablations() {
  static const std::vector<Ablation> rows = {
      {"no-motion-compensation", kParts, {"motion.compensate=false"}},
      {"no-interpolated-navigation", kParts, {"motion.interpolate_navigation=false"}},
      {"no-refinement", kParts, {}, /*navigation_poses=*/true},
      {"no-local-map", kParts, {"refinement.target=previous-scan"}},
      {"no-occluding-test", kParts, {"ray_filter.occluding_test=false"}},
      {"no-occluded-test", kParts, {"ray_filter.occluded_test=false"}},
      {"no-robust-kernel", kParts, {"registration.robust_width=0"}},
      {"no-fusion", kParts, {"fusion.enabled=false"}},
      {"no-loop-closure", kParts, {"fusion.loop_closure=false"}},
      {"no-moving-removal", kParts, {"moving.remove=false"}},
      {"no-ray-filter", kParts, {"ray_filter.mode=off"}},
      {"no-white-zone", kParts, {"foveal.near_range=0", "foveal.far_range=120"}},
      {"no-upsampling", kParts, {"upsample.rate=0"}},
      {"no-bilinear", kParts, {"texture.sampling=nearest"}},
      {"with-slices", kParts, {kSlices}},

      {"method-plane", kPoses, {"registration.method=plane"}},
      {"method-icp", kPoses, {"registration.method=icp"}},
      {"registered-in-view", kPoses, {"refinement.visible_only=true"}},
      {"registered-upsampled-2", kPoses, {"refinement.upsample_rate=2"}},
      {"registered-voxel-0.15", kPoses, {"refinement.voxel=0.15"}},
      {"registered-voxel-0.5", kPoses, {"refinement.voxel=0.5"}},
      {"keyframes-5", kPoses, {"local_map.max_keyframes=5"}},
      {"keyframes-10", kPoses, {"local_map.max_keyframes=10"}},
      {"keyframes-40", kPoses, {"local_map.max_keyframes=40"}},
      {"pair-distance-0.5", kPoses, {"registration.max_distance=0.5"}},
      {"pair-distance-2", kPoses, {"registration.max_distance=2"}},
      {"ground-ransac", kPoses, {"ground.method=ransac"}},

      {"near-1.5", kZone, {"foveal.near_range=1.5"}},
      {"near-5", kZone, {"foveal.near_range=5"}},
      {"far-10", kZone, {"foveal.far_range=10"}},
      {"far-20", kZone, {"foveal.far_range=20"}},
      {"far-30", kZone, {"foveal.far_range=30"}},
      {"half-view", kZone, {kHalfView}},
      {"horizontal-slice", kZone, {kHorizontalSlice}},
      {"incidence-70", kZone, {"foveal.max_incidence=70"}},
      {"incidence-80", kZone, {"foveal.max_incidence=80"}},

      {"rate-1", kDensity, {"upsample.rate=1"}},
      {"rate-3", kDensity, {"upsample.rate=3"}},
      {"tau-0.15", kDensity, {"upsample.max_edge=0.15"}},
      {"tau-0.2", kDensity, {"upsample.max_edge=0.2"}},
      {"tau-0.5", kDensity, {"upsample.max_edge=0.5"}},
      {"tau-1", kDensity, {"upsample.max_edge=1"}},

      {"M-3", kFilter, {"ray_filter.window=3"}},
      {"M-7", kFilter, {"ray_filter.window=7"}},
      {"M-9", kFilter, {"ray_filter.window=9"}},
      {"c-1", kFilter, {"ray_filter.outlier_rate=1"}},
      {"c-1.5", kFilter, {"ray_filter.outlier_rate=1.5"}},
      {"c-2.5", kFilter, {"ray_filter.outlier_rate=2.5"}},
      {"c-3", kFilter, {"ray_filter.outlier_rate=3"}},
  };
  return rows;
}

const Ablation* find_ablation(const std::string& name) {
  const auto found = std::find_if(ablations().begin(), ablations().end(),
                                  [&](const Ablation& row) { return row.name == name; });
  return found != ablations().end() ? &*found : nullptr;
}

}  // namespace fovea::app
