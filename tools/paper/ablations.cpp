#include "tools/paper/ablations.h"

#include <algorithm>

namespace fovea::paper {
namespace {

/// The paper's figure: a horizontal slice tilted down, and a vertical one.
constexpr const char* kSlices = "foveal.slices_deg=[[-25, 25, -20, -10], [-5, 5, -25, 25]]";
constexpr const char* kHorizontalSlice = "foveal.slices_deg=[[-25, 25, -20, -10]]";
/// Half of a camera of 81 degrees.
constexpr const char* kHalfView = "foveal.slices_deg=[[-20, 20, -89, 89]]";

const char* const kParts = "Each part switched off";
const char* const kPoses = "Poses";
const char* const kDense = "Samples and colors";
const char* const kZone = "White zone, slices, incidence";
const char* const kPaper = "The paper mapper with the camera's whole view, and each part changed";
const char* const kDensity = "The paper mapper: rate and tau";
const char* const kFilter = "The paper mapper: M and c";

/// A row of the paper mapper, with the camera's whole view.
Ablation of_paper(const char* name, const char* part, const std::vector<std::string>& changes) {
  std::vector<std::string> settings = {"mapper=paper"};
  settings.insert(settings.end(), changes.begin(), changes.end());
  return {name, part, std::move(settings)};
}

}  // namespace

const std::vector<Ablation>& ablations() {
  static const std::vector<Ablation> rows = {
      {"no-motion-compensation", kParts, {"motion.compensate=false"}},
      {"no-refinement", kParts, {}, /*navigation_poses=*/true},
      {"no-robust-kernel", kParts, {"registration.kernel_width_m=0"}},
      {"no-fusion", kParts, {"fusion.enabled=false"}},
      {"no-loop-closure", kParts, {"fusion.loop_closure=false"}},
      {"no-moving-removal", kParts, {"dynamic.remove=false"}},
      {"no-planar-surfaces", kParts, {"surface.planar_edge_m=0.4"}},
      {"no-footprint", kParts, {"texture.footprint_m=0"}},
      {"with-slices", kParts, {kSlices}},

      {"registered-voxel-0.15", kPoses, {"registration.voxel_m=0.15"}},
      {"registered-voxel-0.5", kPoses, {"registration.voxel_m=0.5"}},
      {"keyframes-5", kPoses, {"local_map.max_keyframes=5"}},
      {"keyframes-20", kPoses, {"local_map.max_keyframes=20"}},
      {"keyframes-every-scan",
       kPoses,
       {"local_map.keyframe_distance_m=0", "local_map.max_keyframes=20"}},

      {"spacing-0.015", kDense, {"surface.spacing_m=0.015", "texture.footprint_m=0.015"}},
      {"spacing-0.03", kDense, {"surface.spacing_m=0.03", "texture.footprint_m=0.03"}},
      {"spacing-0.04", kDense, {"surface.spacing_m=0.04", "texture.footprint_m=0.04"}},
      {"surface-edge-0.2", kDense, {"surface.max_edge_m=0.2"}},
      {"surface-edge-0.3", kDense, {"surface.max_edge_m=0.3"}},
      {"surface-edge-0.5", kDense, {"surface.max_edge_m=0.5"}},
      {"planar-edge-0.6", kDense, {"surface.planar_edge_m=0.6"}},
      {"planar-angle-20", kDense, {"surface.planar_angle_deg=20"}},
      {"planar-angle-40", kDense, {"surface.planar_angle_deg=40"}},
      {"per-pixel-2", kDense, {"surface.max_per_pixel=2"}},
      {"no-limit-per-pixel", kDense, {"surface.max_per_pixel=0"}},
      {"footprint-0.01", kDense, {"texture.footprint_m=0.01"}},
      {"footprint-0.03", kDense, {"texture.footprint_m=0.03"}},

      {"far-10", kZone, {"foveal.far_range_m=10"}},
      {"far-15", kZone, {"foveal.far_range_m=15"}},
      {"far-22", kZone, {"foveal.far_range_m=22"}},
      {"far-30", kZone, {"foveal.far_range_m=30"}},
      {"far-120", kZone, {"foveal.far_range_m=120"}},
      {"half-view", kZone, {kHalfView}},
      {"horizontal-slice", kZone, {kHorizontalSlice}},
      {"incidence-70", kZone, {"foveal.max_incidence_deg=70"}},
      {"incidence-80", kZone, {"foveal.max_incidence_deg=80"}},

      of_paper("paper-mapping", kPaper, {}),
      of_paper("no-upsampling", kPaper, {"upsample.rate=0"}),
      of_paper("no-bilinear", kPaper, {"texture.sampling=nearest"}),
      of_paper("ground-ransac", kPaper, {"ground.method=ransac"}),
      of_paper("near-1.5", kPaper, {"foveal.near_range_m=1.5"}),
      of_paper("near-5", kPaper, {"foveal.near_range_m=5"}),

      of_paper("rate-1", kDensity, {"upsample.rate=1"}),
      of_paper("rate-3", kDensity, {"upsample.rate=3"}),
      of_paper("tau-0.15", kDensity, {"upsample.max_edge_m=0.15"}),
      of_paper("tau-0.2", kDensity, {"upsample.max_edge_m=0.2"}),
      of_paper("tau-0.5", kDensity, {"upsample.max_edge_m=0.5"}),
      of_paper("tau-1", kDensity, {"upsample.max_edge_m=1"}),

      of_paper("M-3", kFilter, {"ray_filter.window_px=3"}),
      of_paper("M-7", kFilter, {"ray_filter.window_px=7"}),
      of_paper("M-9", kFilter, {"ray_filter.window_px=9"}),
      of_paper("c-1", kFilter, {"ray_filter.outlier_rate=1"}),
      of_paper("c-1.5", kFilter, {"ray_filter.outlier_rate=1.5"}),
      of_paper("c-2.5", kFilter, {"ray_filter.outlier_rate=2.5"}),
      of_paper("c-3", kFilter, {"ray_filter.outlier_rate=3"}),
  };
  return rows;
}

const Ablation* find_ablation(const std::string& name) {
  const auto found = std::find_if(ablations().begin(), ablations().end(),
                                  [&](const Ablation& row) { return row.name == name; });
  return found != ablations().end() ? &*found : nullptr;
}

}  // namespace fovea::paper
