#include "fovea/pipeline/settings_rows.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "fovea/core/angle.h"
namespace fovea {
namespace {

constexpr int kMaxCameras = 10;
constexpr const char* kSliceForm =
    "rows of [azimuth_min, azimuth_max, elevation_min, elevation_max]";

void visit_slices(SettingVisitor& visit, std::string_view key, std::vector<AngularSlice>& slices) {
  std::vector<std::array<double, 4>> rows;
  rows.reserve(slices.size());
  for (const AngularSlice& s : slices) {
    rows.push_back({s.azimuth_min, s.azimuth_max, s.elevation_min, s.elevation_max});
  }
  visit(key, DegreeRows{rows, "[azimuth_min, azimuth_max, elevation_min, elevation_max]"});
  slices.clear();
  for (const auto& row : rows) slices.push_back({row[0], row[1], row[2], row[3]});
}

bool are_valid(const std::vector<AngularSlice>& slices) {
  constexpr double kQuarter = 90 * kDegree;
  return std::all_of(slices.begin(), slices.end(), [](const AngularSlice& slice) {
    return slice.azimuth_min < slice.azimuth_max && slice.elevation_min < slice.elevation_max &&
           slice.azimuth_min > -kQuarter && slice.azimuth_max < kQuarter &&
           slice.elevation_min > -kQuarter && slice.elevation_max < kQuarter;
  });
}

Setting slices_row(std::vector<AngularSlice>& slices) {
  constexpr const char* kKey = "foveal.slices_deg";
  return {
      kKey,
      kSliceForm,
      [&slices](SettingVisitor& visit) { visit_slices(visit, kKey, slices); },
      [&slices] { slices.clear(); },
      [&slices] { return are_valid(slices) ? "" : kKey; },
      "Parts of the camera's view in which texture is mapped, about the optical axis, right and "
      "up positive; none: the whole view."};
}

std::string camera_key(int camera) { return fmt::format("foveal.camera_{}_slices_deg", camera); }

/// Keys that are there only where a camera has slices of its own.
Setting camera_slices_row(std::map<int, std::vector<AngularSlice>>& of_cameras) {
  const auto visit_all = [&of_cameras](SettingVisitor& visit) {
    for (int camera = 0; camera < kMaxCameras; ++camera) {
      const std::string key = camera_key(camera);
      const auto own = of_cameras.find(camera);
      auto slices = own != of_cameras.end() ? own->second : std::vector<AngularSlice>{};
      if (slices.empty() && !visit.is_given(key)) continue;
      visit_slices(visit, key, slices);
      if (!slices.empty()) of_cameras[camera] = std::move(slices);
    }
  };
  const auto violation = [&of_cameras] {
    for (const auto& [camera, slices] : of_cameras) {
      if (!are_valid(slices)) return camera_key(camera);
    }
    return std::string();
  };
  return {kCameraSlicesKey, kSliceForm,
          visit_all,        [&of_cameras] { of_cameras.clear(); },
          violation,        "Slices of camera K (0 to 9), in place of foveal.slices_deg."};
}

Setting far_range_row(FovealOptions& foveal, double default_value) {
  return Setting{"foveal.far_range_m", foveal.far_range, default_value, above(0, 1000),
                 "Distance from the LiDAR at which the foveal region ends."}
      .with_rule("more than the near range",
                 [&foveal] { return foveal.far_range > foveal.near_range; });
}

Setting periphery_row(FovealOptions& foveal) {
  return {
      "foveal.periphery_range_m", foveal.periphery_range, 60, zero_or(1, 1000),
      "Distance from the LiDAR at which the periphery ends, which has coarser points; 0 maps the "
      "foveal region alone."};
}

Setting incidence_row(FovealOptions& foveal) {
  return {"foveal.max_incidence_deg", Degrees{foveal.max_incidence}, 90, above(0, 90),
          "Largest angle between view ray and surface normal; 90 switches the limit off."};
}

/// Settings of a run, for both mappers. The paper mapper trusts its calibration.
SettingsTable run_rows(RunOptions& o, MapperKind mapper) {
  return {
      {"input.max_damaged_share", o.max_damaged_share, 0.5, between(0, 1),
       "Share of the frames that may be damaged; a run with more ends with an error."},
      {"calibration.check", o.check_calibration, mapper == MapperKind::kDefault,
       "Estimates rotation and delay of the cameras from edges of up to 20 frames, and warns "
       "beyond "
       "one pixel."},
      {"map.range_image_spacing_m", o.range_image_spacing,
       mapper == MapperKind::kDefault ? 5.0 : 0.0, between(0, 1000),
       "Distance between scans whose range images the map keeps, to align other maps with it and "
       "to "
       "show free space; 0 keeps none."},
  };
}

Setting tile_size_row(double& tile_size) {
  return {"map.tile_size_m", tile_size, 4, between(0.5, 65), "Edge of the map's tiles."};
}

SettingsTable registration_rows(RefinementOptions& o) {
  return {
      {"registration.max_points", o.registration.max_points, 12000, between(0, 10'000'000),
       "Points of a scan that are registered, at even steps; 0 takes all."},
      {"registration.kernel_width_m", o.registration.robust_width, 0.1, between(0, 100),
       "Width of the Geman-McClure kernel, which keeps moving things from pulling; 0 switches it "
       "off."},
      {"registration.voxel_m", o.voxel, 0.25, between(0, 10),
       "Voxel of which at most one point of a scan is registered; 0 keeps all."},
      {"local_map.max_keyframes", o.local_map.max_keyframes, 10, between(1, 1000),
       "Scans in the local map."},
      {"local_map.keyframe_distance_m", o.local_map.keyframe_distance, 1.5, between(0, 1000),
       "Distance from one keyframe to the next; 0 takes every scan."},
      {"local_map.keyframe_rotation_deg", Degrees{o.local_map.keyframe_rotation}, 2.5,
       above(0, 180), "Rotation from one keyframe to the next, where the distance is shorter."},
  };
}

SettingsTable surface_rows(SurfaceOptions& o) {
  return {
      {"surface.spacing_m", o.spacing, 0.02, between(0.005, 1),
       "Distance between the samples of a surface."},
      {"surface.max_edge_m", o.max_edge, 0, between(0, 100),
       "Longest edge of a triangle that is surface; 0 takes it from the LiDAR's rings (0.4 to 1 "
       "m)."},
      {"surface.planar_edge_m", o.planar_edge, 0, between(0, 100),
       "The same for a triangle in a plane with its neighbors; 0 takes it from the LiDAR's rings "
       "(1 "
       "to 4 m)."},
      {"surface.planar_angle_deg", Degrees{o.planar_angle}, 30, between(0, 90),
       "Largest angle between the normals of such neighbors."},
      {"surface.max_per_pixel", o.max_per_pixel, 4, zero_or(0.1, 1000),
       "Samples in one pixel of the image; 0 sets no limit."},
  };
}

SettingsTable default_rows(MapperOptions& o) {
  SettingsTable table{tile_size_row(o.tile_size),
                      {"motion.compensate", o.compensate_motion, true,
                       "Moves each point of a raw sweep to the time stamp of its scan."}};
  const auto add = [&table](SettingsTable rows) {
    std::move(rows.begin(), rows.end(), std::back_inserter(table));
  };
  add(registration_rows(o.refinement));
  add({far_range_row(o.foveal, 18), periphery_row(o.foveal), incidence_row(o.foveal),
       slices_row(o.foveal.slices), camera_slices_row(o.foveal.camera_slices)});
  add(surface_rows(o.surface));
  add({
      {"texture.footprint_m", o.footprint, 0.015, between(0, 1),
       "Edge of the patch whose mean color a view gives to a point."},
      {"dynamic.remove", o.dynamic.remove, true,
       "Removes points that scans before or after them see through."},
      {"dynamic.range_m", o.dynamic.range, 60, above(0, 200),
       "Distance from the LiDAR up to which each scan checks the points of the map."},
      {"dynamic.free_scans", o.dynamic.free_scans, 4, between(1, DynamicPointFilter::kMemory),
       "Scans that see through a place before its points are removed."},
      {"fusion.enabled", o.fusion.enabled, true,
       "Moves the submaps to where registration, navigation and closed loops agree best."},
      {"fusion.loop_closure", o.fusion.loop_closure, true, "Registers places that are seen again."},
      {"fusion.submap_duration_s", o.fusion.submap_duration, 2, above(0, 3600),
       "Shortest duration of a submap, whose points keep their places to each other."},
  });
  return table;
}

SettingsTable paper_rows(PaperOptions& o) {
  return {
      tile_size_row(o.tile_size),
      {"ground.method", o.ground.method, GroundMethod::kHeight,
       "How the ground is found: by a threshold of the height, or by a plane (RANSAC)."},
      {"ground.sensor_height_m", o.ground.sensor_height, 0, between(0, 10),
       "Height of the LiDAR above the road; 0 takes that of the LiDAR's profile."},
      {"registration.method", o.registration, RegistrationMethod::kPointToPoint,
       "How a scan is registered to the previous one: GICP, point to point, or point to plane."},
      {"upsample.rate", o.upsample.rate, 2, between(0, 5),
       "How often the centroids of the triangles are inserted."},
      {"upsample.max_edge_m", o.upsample.max_edge, 0.3, above(0, 1000),
       "Longest edge of a triangle that is filled (tau)."},
      {"foveal.enabled", o.foveal_enabled, true,
       "Maps the foveal region alone; false maps whole scans (the baselines)."},
      {"foveal.near_range_m", o.foveal.near_range, 3, between(0, 1000),
       "Distance from the LiDAR at which the foveal region begins."},
      far_range_row(o.foveal, 15),
      incidence_row(o.foveal),
      slices_row(o.foveal.slices),
      camera_slices_row(o.foveal.camera_slices),
      {"ray_filter.window_px", o.ray_filter.window, 5, odd_between(1, 101),
       "Edge of the window around a pixel (M)."},
      {"ray_filter.outlier_rate", o.ray_filter.outlier_rate, 2, above(0, 1e6),
       "Standard deviations from the mean length beyond which a ray is an outlier (c)."},
      {"texture.sampling", o.sampling, ImageSampling::kBilinear,
       "How a color is read between the centers of pixels."},
  };
}

}  // namespace

SettingsTable settings_rows(MapSettings& settings) {
  SettingsTable table = run_rows(settings.run, mapper_of(settings));
  SettingsTable rows =
      settings.is_paper() ? paper_rows(settings.paper()) : default_rows(settings.mapper());
  std::move(rows.begin(), rows.end(), std::back_inserter(table));
  return table;
}

MapSettings default_settings(MapperKind mapper) {
  MapSettings settings;
  if (mapper == MapperKind::kPaper) settings.method = PaperOptions{};
  for (const Setting& row : settings_rows(settings)) row.reset();
  return settings;
}

MapperKind mapper_of(const MapSettings& settings) {
  return settings.is_paper() ? MapperKind::kPaper : MapperKind::kDefault;
}

}  // namespace fovea
