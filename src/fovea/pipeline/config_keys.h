// The one list of configuration keys. Angles are degrees in the keys, radians in the options.
#pragma once

#include <fmt/format.h>

#include <array>
#include <string_view>
#include <vector>

#include "fovea/base/settings.h"
#include "fovea/pipeline/mapper_options.h"

namespace fovea {

constexpr auto names_of(RegistrationMethod) {
  return std::array{
      EnumName<RegistrationMethod>{RegistrationMethod::kGicp, std::string_view("gicp")},
      EnumName<RegistrationMethod>{RegistrationMethod::kPointToPoint, std::string_view("icp")},
      EnumName<RegistrationMethod>{RegistrationMethod::kPointToPlane, std::string_view("plane")}};
}
constexpr auto names_of(RegistrationTarget) {
  return std::array{
      EnumName<RegistrationTarget>{RegistrationTarget::kPreviousScan,
                                   std::string_view("previous-scan")},
      EnumName<RegistrationTarget>{RegistrationTarget::kLocalMap, std::string_view("local-map")}};
}
constexpr auto names_of(GroundMethod) {
  return std::array{EnumName<GroundMethod>{GroundMethod::kHeight, std::string_view("height")},
                    EnumName<GroundMethod>{GroundMethod::kRansac, std::string_view("ransac")}};
}
constexpr auto names_of(RayFilterMode) {
  return std::array{EnumName<RayFilterMode>{RayFilterMode::kPaper, std::string_view("paper")},
                    EnumName<RayFilterMode>{RayFilterMode::kScan, std::string_view("scan")},
                    EnumName<RayFilterMode>{RayFilterMode::kOff, std::string_view("off")}};
}

constexpr auto names_of(ImageSampling) {
  return std::array{EnumName<ImageSampling>{ImageSampling::kBilinear, std::string_view("bilinear")},
                    EnumName<ImageSampling>{ImageSampling::kNearest, std::string_view("nearest")}};
}

constexpr auto names_of(TextureViews) {
  return std::array{EnumName<TextureViews>{TextureViews::kFirst, std::string_view("first")},
                    EnumName<TextureViews>{TextureViews::kMean, std::string_view("mean")}};
}

inline constexpr int kMaxCameras = 10;

/// Slices, written as an array of [azimuth_min, azimuth_max, elevation_min, elevation_max] in
/// degrees.
inline void visit_slices(SettingVisitor& visit, std::string_view key,
                         std::vector<AngularSlice>& slices) {
  std::vector<std::array<double, 4>> rows;
  rows.reserve(slices.size());
  for (const AngularSlice& s : slices) {
    rows.push_back({s.azimuth_min, s.azimuth_max, s.elevation_min, s.elevation_max});
  }
  visit(key, DegreeRows{rows, "[azimuth_min, azimuth_max, elevation_min, elevation_max]"});
  slices.clear();
  for (const auto& row : rows) slices.push_back({row[0], row[1], row[2], row[3]});
}

/// Calls `visit(key, reference)` for every key; a reader assigns, a writer prints.
inline void visit_config(SettingVisitor& visit, MapperOptions& o) {
  visit("input.max_damaged_share", o.max_damaged_share);
  visit("motion.compensate", o.compensate_motion);
  visit("motion.interpolate_navigation", o.interpolate_navigation);

  RefinementOptions& r = o.refinement;
  visit("refinement.target", r.target);
  visit("refinement.visible_only", r.visible_only);
  visit("refinement.upsample_rate", r.upsample_rate);
  visit("refinement.voxel", r.voxel);
  visit("refinement.max_correction_translation", r.max_correction_translation);
  visit("refinement.max_correction_rotation", Degrees{r.max_correction_rotation});

  visit("ground.method", r.ground.method);
  visit("ground.sensor_height", r.ground.sensor_height);
  visit("ground.tolerance", r.ground.tolerance);
  visit("ground.ransac_iterations", r.ground.ransac_iterations);
  visit("ground.ransac_max_tilt", r.ground.ransac_max_tilt);

  visit("registration.method", r.registration.method);
  visit("registration.max_iterations", r.registration.max_iterations);
  visit("registration.max_points", r.registration.max_points);
  visit("registration.max_distance", r.registration.max_distance);
  visit("registration.converged_rotation", r.registration.converged_rotation);
  visit("registration.converged_translation", r.registration.converged_translation);
  visit("registration.neighbors", r.registration.neighbors);
  visit("registration.plane_epsilon", r.registration.plane_epsilon);
  visit("registration.robust_width", r.registration.robust_width);
  visit("registration.degenerate_eigenvalue", r.registration.degenerate_eigenvalue);

  visit("local_map.max_keyframes", r.local_map.max_keyframes);
  visit("local_map.keyframe_distance", r.local_map.keyframe_distance);
  visit("local_map.keyframe_rotation", Degrees{r.local_map.keyframe_rotation});
  visit("local_map.keyframe_overlap", r.local_map.keyframe_overlap);
  visit("local_map.max_range", r.local_map.max_range);
  visit("local_map.voxel", r.local_map.voxel);

  visit("foveal.enabled", o.foveal_enabled);
  visit("foveal.near_range", o.foveal.near_range);
  visit("foveal.far_range", o.foveal.far_range);
  visit("foveal.max_incidence", Degrees{o.foveal.max_incidence});
  visit_slices(visit, "foveal.slices", o.foveal.slices);
  for (int camera = 0; camera < kMaxCameras; ++camera) {
    const std::string key = fmt::format("foveal.camera_{}_slices", camera);
    // Present only where a camera has slices of its own.
    const auto own = o.camera_slices.find(camera);
    auto slices = own != o.camera_slices.end() ? own->second : std::vector<AngularSlice>{};
    if (slices.empty() && !visit.is_given(key)) continue;
    visit_slices(visit, key, slices);
    if (!slices.empty()) o.camera_slices[camera] = std::move(slices);
  }

  visit("surface.spacing", o.surface.spacing);
  visit("surface.max_edge", o.surface.max_edge);
  visit("surface.planar_edge", o.surface.planar_edge);
  visit("surface.planar_angle", Degrees{o.surface.planar_angle});
  visit("surface.max_per_pixel", o.surface.max_per_pixel);

  visit("upsample.rate", o.upsample.rate);
  visit("upsample.max_edge", o.upsample.max_edge);

  visit("ray_filter.mode", o.ray_filter.mode);
  visit("ray_filter.window", o.ray_filter.window);
  visit("ray_filter.outlier_rate", o.ray_filter.outlier_rate);
  visit("ray_filter.occluding_test", o.ray_filter.occluding_test);
  visit("ray_filter.occluded_test", o.ray_filter.occluded_test);

  visit("texture.views", o.texture.views);
  visit("texture.footprint", o.texture.footprint);
  visit("texture.sampling", o.texture.sampling);

  visit("moving.remove", o.moving.remove);
  visit("moving.range", o.moving.range);
  visit("moving.free_scans", o.moving.free_scans);

  visit("fusion.enabled", o.fusion.enabled);
  visit("fusion.loop_closure", o.fusion.loop_closure);
  visit("calibration.check", o.check_calibration);

  visit("map.tile_size", o.tile_size);
  visit("map.submap_duration", o.fusion.submap_duration);
}

}  // namespace fovea
