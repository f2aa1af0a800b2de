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
const char* const kDense = "Samples and colours";
const char* const kZone = "White zone, slices, incidence";
const char* const kPaper =
    "The paper's mapping with the default's poses, and each part of it switched off";
const char* const kDensity = "The paper's mapping: rate and tau";
const char* const kFilter = "The paper's mapping: M and c";

/// A change of the paper's mapping: upsampling by centroids, its ray filter, one view.
std::vector<std::string> paper_mapping(const std::vector<std::string>& changes) {
  std::vector<std::string> settings = {"surface.spacing=0", "ray_filter.mode=paper",
                                       "texture.views=first", "foveal.far_range=15"};
  settings.insert(settings.end(), changes.begin(), changes.end());
  return settings;
}

}  // namespace

const std::vector<Ablation>& ablations() {
  static const std::vector<Ablation> rows = {
      {"no-motion-compensation", kParts, {"motion.compensate=false"}},
      {"no-interpolated-navigation", kParts, {"motion.interpolate_navigation=false"}},
      {"no-refinement", kParts, {}, /*navigation_poses=*/true},
      {"no-local-map", kParts, {"refinement.target=previous-scan"}},
      {"no-robust-kernel", kParts, {"registration.robust_width=0"}},
      {"no-fusion", kParts, {"fusion.enabled=false"}},
      {"no-loop-closure", kParts, {"fusion.loop_closure=false"}},
      {"no-moving-removal", kParts, {"moving.remove=false"}},
      {"no-ray-filter", kParts, {"ray_filter.mode=off"}},
      {"no-white-zone", kParts, {"foveal.near_range=0", "foveal.far_range=120"}},
      {"no-dense-samples", kParts, {"surface.spacing=0"}},
      {"no-planar-surfaces", kParts, {"surface.planar_edge=0.4"}},
      {"no-fused-colours", kParts, {"texture.views=first"}},
      {"no-footprint", kParts, {"texture.footprint=0"}},
      {"with-slices", kParts, {kSlices}},

      {"method-gicp", kPoses, {"registration.method=gicp"}},
      {"method-icp", kPoses, {"registration.method=icp"}},
      {"registered-in-view", kPoses, {"refinement.visible_only=true"}},
      {"registered-upsampled-2", kPoses, {"refinement.upsample_rate=2"}},
      {"registered-voxel-0.15", kPoses, {"refinement.voxel=0.15"}},
      {"registered-voxel-0.5", kPoses, {"refinement.voxel=0.5"}},
      {"keyframes-5", kPoses, {"local_map.max_keyframes=5"}},
      {"keyframes-20", kPoses, {"local_map.max_keyframes=20"}},
      {"keyframes-every-scan",
       kPoses,
       {"local_map.keyframe_distance=0", "local_map.max_keyframes=20"}},
      {"pair-distance-0.5", kPoses, {"registration.max_distance=0.5"}},
      {"pair-distance-2", kPoses, {"registration.max_distance=2"}},
      {"ground-ransac", kPoses, {"ground.method=ransac"}},

      {"spacing-0.015", kDense, {"surface.spacing=0.015", "texture.footprint=0.015"}},
      {"spacing-0.03", kDense, {"surface.spacing=0.03", "texture.footprint=0.03"}},
      {"spacing-0.04", kDense, {"surface.spacing=0.04", "texture.footprint=0.04"}},
      {"surface-edge-0.2", kDense, {"surface.max_edge=0.2"}},
      {"surface-edge-0.3", kDense, {"surface.max_edge=0.3"}},
      {"surface-edge-0.5", kDense, {"surface.max_edge=0.5"}},
      {"planar-edge-0.6", kDense, {"surface.planar_edge=0.6"}},
      {"planar-angle-20", kDense, {"surface.planar_angle=20"}},
      {"planar-angle-40", kDense, {"surface.planar_angle=40"}},
      {"per-pixel-2", kDense, {"surface.max_per_pixel=2"}},
      {"no-limit-per-pixel", kDense, {"surface.max_per_pixel=0"}},
      {"footprint-0.01", kDense, {"texture.footprint=0.01"}},
      {"footprint-0.03", kDense, {"texture.footprint=0.03"}},
      {"paper-filter", kDense, {"ray_filter.mode=paper"}},

      {"near-1.5", kZone, {"foveal.near_range=1.5"}},
      {"near-5", kZone, {"foveal.near_range=5"}},
      {"far-10", kZone, {"foveal.far_range=10"}},
      {"far-15", kZone, {"foveal.far_range=15"}},
      {"far-22", kZone, {"foveal.far_range=22"}},
      {"far-30", kZone, {"foveal.far_range=30"}},
      {"half-view", kZone, {kHalfView}},
      {"horizontal-slice", kZone, {kHorizontalSlice}},
      {"incidence-70", kZone, {"foveal.max_incidence=70"}},
      {"incidence-80", kZone, {"foveal.max_incidence=80"}},

      {"paper-mapping", kPaper, paper_mapping({})},
      {"no-occluding-test", kPaper, paper_mapping({"ray_filter.occluding_test=false"})},
      {"no-occluded-test", kPaper, paper_mapping({"ray_filter.occluded_test=false"})},
      {"no-upsampling", kPaper, paper_mapping({"upsample.rate=0"})},
      {"no-bilinear", kPaper, paper_mapping({"texture.sampling=nearest"})},

      {"rate-1", kDensity, paper_mapping({"upsample.rate=1"})},
      {"rate-3", kDensity, paper_mapping({"upsample.rate=3"})},
      {"tau-0.15", kDensity, paper_mapping({"upsample.max_edge=0.15"})},
      {"tau-0.2", kDensity, paper_mapping({"upsample.max_edge=0.2"})},
      {"tau-0.5", kDensity, paper_mapping({"upsample.max_edge=0.5"})},
      {"tau-1", kDensity, paper_mapping({"upsample.max_edge=1"})},

      {"M-3", kFilter, paper_mapping({"ray_filter.window=3"})},
      {"M-7", kFilter, paper_mapping({"ray_filter.window=7"})},
      {"M-9", kFilter, paper_mapping({"ray_filter.window=9"})},
      {"c-1", kFilter, paper_mapping({"ray_filter.outlier_rate=1"})},
      {"c-1.5", kFilter, paper_mapping({"ray_filter.outlier_rate=1.5"})},
      {"c-2.5", kFilter, paper_mapping({"ray_filter.outlier_rate=2.5"})},
      {"c-3", kFilter, paper_mapping({"ray_filter.outlier_rate=3"})},
  };
  return rows;
}

const Ablation* find_ablation(const std::string& name) {
  const auto found = std::find_if(ablations().begin(), ablations().end(),
                                  [&](const Ablation& row) { return row.name == name; });
  return found != ablations().end() ? &*found : nullptr;
}

}  // namespace fovea::app
